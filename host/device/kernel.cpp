// SPDX-License-Identifier: Apache-2.0
#include "device/kernel.h"

#include "device/state.h"

namespace sunstone {

// One local size for every launch of a kernel, as PoCL compiles once for each (docs/kernels.md). Kernels that give each work-item a whole chunk say
// so by the end of their name: groups of one spread them over the cores.
static std::size_t local_size(const DeviceInfo &info, const DeviceOptions &options, const std::string &name) {
  std::size_t local = options.work_group ? options.work_group : 64;
  if (info.cpu && name.ends_with("_chunks")) local = 1;
  return std::min(local, info.max_work_group ? info.max_work_group : 1);
}

Kernel::Kernel(const Program &program, const std::string &name) : Kernel(program, name, program.state().device) {}

Kernel::Kernel(const Program &program, const std::string &name, const Device &queue) : state_(std::make_shared<State>(State{queue, program, {}, name, {}, 0})) {
  guarded(program.state().name + ": kernel " + name, [&] { state_->kernel = cl::Kernel(program.state().program, name.c_str()); });
  Device::State &device = state_->device.state();
  std::size_t local = local_size(device.info, device.options, name);
  const auto limit = state_->kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.device);
  if (limit > 0 && local > limit) local = limit;
  state_->local = local;
}

const std::string &Kernel::name() const { return state_->name; }

void Kernel::set_buffer(unsigned at, const RawBuffer &buffer) {
  guarded(state_->name + ": argument " + std::to_string(at), [&] { state_->kernel.setArg(at, buffer.state().buffer); });
  if (state_->bound.size() <= at) state_->bound.resize(at + 1);
  state_->bound[at] = buffer;
}

void Kernel::set_bytes(unsigned at, const void *data, std::size_t size) {
  guarded(state_->name + ": argument " + std::to_string(at), [&] { state_->kernel.setArg(at, size, data); });
}

void Kernel::check_bound(unsigned count) const {
  const auto wanted = state_->kernel.getInfo<CL_KERNEL_NUM_ARGS>();
  if (wanted != count) throw Error(state_->name, "takes " + std::to_string(wanted) + " arguments, " + std::to_string(count) + " were given");
}

void Kernel::launch(std::size_t items) const {
  if (items == 0) return;
  Device::State &device = state_->device.state();
  const std::size_t global = (items + state_->local - 1) / state_->local * state_->local;
  cl::Event event;
  guarded("kernel " + state_->name, [&] {
    return device.queue.enqueueNDRangeKernel(state_->kernel, cl::NullRange, cl::NDRange(global), cl::NDRange(state_->local), nullptr,
                                             device.options.profile ? &event : nullptr);
  });
  if (device.options.profile) {
    device.launches.push_back({state_->name, items, event});
    if (device.launches.size() > 4096) device.sum_up();
  }
}

}  // namespace sunstone
