// SPDX-License-Identifier: Apache-2.0
// OpenCL devices: found, described, chosen, opened. `cl::` appears in host/device/ only.
#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/notice.h"

namespace sunstone {

struct DeviceInfo {
  int index = 0;  // over all platforms, as `sunstone devices` lists them
  std::string platform, name, vendor, driver, version, c_version;
  bool cpu = false, gpu = false;  // gpu: the GPU bit without the CPU bit (Oclgrind has all)
  unsigned compute_units = 0;
  std::size_t memory = 0, max_allocation = 0, max_work_group = 0, local_memory = 0;
  unsigned native_float_width = 1;
  bool unified_memory = false;      // the host's own
  bool atomics_64 = false;          // cl_khr_int64_base_atomics
  bool correct_divide_sqrt = false; // reports CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT
  bool available = true;            // compiler and device available, 32-bit atomics there
  std::string unusable;             // why not, where it is not
  std::string description() const;  // "Portable Computing Language: pthread-AMD EPYC (2 units, 21.4 GiB)"
};

struct StageTime {
  std::string kernel;
  std::size_t launches = 0, items = 0;
  double seconds = 0;  // on the device, by its profiling events
};

// Every device of every platform. Never throws for a broken platform: that is a warning.
std::vector<DeviceInfo> list_devices(Notices &notices);

// index, part of a name (any case), "cpu", "gpu"; empty: the first GPU, else the CPU with most units. Throws UsageError with what there is, or Error
// naming the package to install where there is none.
DeviceInfo choose_device(const std::vector<DeviceInfo> &devices, const std::string &selector);

struct DeviceOptions {
  unsigned threads = 0;       // CPU devices: at most so many compute units (device fission); 0: all
  bool profile = true;
  std::size_t work_group = 0; // local size of every launch; 0: the default
};

// An opened device: context, in-order profiling queue, and the bytes that were allocated on it. Copies share all of it.
class Device {
 public:
  Device() = default;
  Device(const DeviceInfo &info, const DeviceOptions &options);
  const DeviceInfo &info() const;
  const DeviceOptions &options() const;
  std::size_t allocated() const;
  // The same device with another queue, and times of its own: what is enqueued there and here may run at once.
  Device beside() const;
  void flush() const;
  void finish() const;
  // Device seconds by kernel since the last call; waits for what is running.
  std::vector<StageTime> take_times() const;

  struct State;  // device/state.h, for this folder alone
  State &state() const { return *state_; }
  explicit operator bool() const { return state_ != nullptr; }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace sunstone
