// SPDX-License-Identifier: Apache-2.0
#include "device/buffer.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cstdlib>

#include "device/state.h"

namespace sunstone {

static std::string mebibytes(std::size_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / 1048576.0); }

// Large buffers of a CPU stand in memory of our own, in pages of 2 MiB where the system has them: rays jump about in a tree, and a walk through the
// page table for each jump is felt. The device uses it in place.
static cl::Buffer make_buffer(const Device::State &owner, std::size_t bytes) {
  constexpr std::size_t large_page = std::size_t(2) << 20;
  const std::size_t rounded = (bytes + large_page - 1) / large_page * large_page;
  void *pages = owner.info.cpu && owner.info.unified_memory && bytes >= large_page ? std::aligned_alloc(large_page, rounded) : nullptr;
  if (!pages) return cl::Buffer(owner.context, CL_MEM_READ_WRITE, bytes);
  madvise(pages, rounded, MADV_HUGEPAGE);  // only a wish
  try {
    cl::Buffer buffer(owner.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, pages);
    buffer.setDestructorCallback([](cl_mem, void *memory) { std::free(memory); }, pages);
    return buffer;
  } catch (...) {
    std::free(pages);
    throw;
  }
}

RawBuffer::State::~State() {
  if (device) *device.state().allocated -= bytes;
}

RawBuffer::RawBuffer(const Device &device, std::size_t bytes, std::string what) : bytes_(bytes) {
  Device::State &owner = device.state();
  const std::string place = owner.info.name + ": " + what;
  if (bytes > owner.info.max_allocation)
    throw Error(place, "needs " + mebibytes(bytes) + " in one piece; the device allows " + mebibytes(owner.info.max_allocation));
  if (*owner.allocated + bytes > owner.info.memory)
    throw Error(place, "needs " + mebibytes(bytes) + ", but " + mebibytes(*owner.allocated) + " of the device's " + mebibytes(owner.info.memory) + " are in use");
  state_ = std::make_shared<State>();
  state_->what = std::move(what);
  state_->buffer = guarded(place, [&] { return make_buffer(owner, bytes); });
  state_->device = device;
  state_->bytes = bytes;
  *owner.allocated += bytes;
}

void RawBuffer::write(const void *data, std::size_t bytes, std::size_t offset) const {
  if (offset > bytes_ || bytes > bytes_ - offset) throw Error(state_->what, "write beyond the end of a device buffer");
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueWriteBuffer(state_->buffer, CL_TRUE, offset, bytes, data); });
}

void RawBuffer::write_later(const void *data, std::size_t bytes) const {
  if (bytes > bytes_) throw Error(state_->what, "write beyond the end of a device buffer");
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueWriteBuffer(state_->buffer, CL_FALSE, 0, bytes, data); });
}

void RawBuffer::read(void *data, std::size_t bytes, std::size_t offset) const {
  if (offset > bytes_ || bytes > bytes_ - offset) throw Error(state_->what, "read beyond the end of a device buffer");
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueReadBuffer(state_->buffer, CL_TRUE, offset, bytes, data); });
}

void RawBuffer::fill_zero() const {
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueFillBuffer(state_->buffer, cl_uchar(0), 0, bytes_); });
}

}  // namespace sunstone
