// SPDX-License-Identifier: Apache-2.0
#include "device/buffer.h"

#include <fmt/format.h>

#include "device/state.h"

namespace sunstone {

static std::string mebibytes(std::size_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / 1048576.0); }

RawBuffer::State::~State() {
  if (device) device.state().allocated -= bytes;
}

RawBuffer::RawBuffer(const Device &device, std::size_t bytes, std::string what) : bytes_(bytes) {
  Device::State &owner = device.state();
  const std::string place = owner.info.name + ": " + what;
  if (bytes > owner.info.max_allocation)
    throw Error(place, "needs " + mebibytes(bytes) + " in one piece; the device allows " + mebibytes(owner.info.max_allocation));
  if (owner.allocated + bytes > owner.info.memory)
    throw Error(place, "needs " + mebibytes(bytes) + ", but " + mebibytes(owner.allocated) + " of the device's " + mebibytes(owner.info.memory) + " are in use");
  state_ = std::make_shared<State>();
  state_->what = std::move(what);
  state_->buffer = guarded(place, [&] { return cl::Buffer(owner.context, CL_MEM_READ_WRITE, bytes); });
  state_->device = device;
  state_->bytes = bytes;
  owner.allocated += bytes;
}

void RawBuffer::write(const void *data, std::size_t bytes, std::size_t offset) const {
  if (offset > bytes_ || bytes > bytes_ - offset) throw Error(state_->what, "write beyond the end of a device buffer");
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueWriteBuffer(state_->buffer, CL_TRUE, offset, bytes, data); });
}

void RawBuffer::read(void *data, std::size_t bytes, std::size_t offset) const {
  if (offset > bytes_ || bytes > bytes_ - offset) throw Error(state_->what, "read beyond the end of a device buffer");
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueReadBuffer(state_->buffer, CL_TRUE, offset, bytes, data); });
}

void RawBuffer::fill_zero() const {
  guarded(state_->what, [&] { return state_->device.state().queue.enqueueFillBuffer(state_->buffer, cl_uchar(0), 0, bytes_); });
}

}  // namespace sunstone
