// SPDX-License-Identifier: Apache-2.0
// Does this device give the host's bits? Some 270 000 results of kernels/math/selftest.h, per width of lanes, summed as hashes section by section.
#pragma once
#include <string>

#include "device/device.h"

namespace sunstone {

struct SelfTestResult {
  bool reproducible = false;
  std::string differs;  // the first operation that differs, and at which LANES: "divide (lanes 16)"; empty where none does
  double seconds = 0;   // that the test took, its build included; 0 where the verdict was remembered
};

// Runs the test. Throws Error where the device cannot build or run it at all.
SelfTestResult self_test(const Device &device);

// The verdict of an earlier run on this device, driver and kernel source, or else of a run now. A damaged entry is as good as none.
SelfTestResult cached_self_test(const Device &device);

}  // namespace sunstone
