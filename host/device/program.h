// SPDX-License-Identifier: Apache-2.0
// Source and switches -> program, cached on disk by hash of source, options, device and driver.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "device/device.h"

namespace sunstone {

using Switches = std::map<std::string, int>;  // -DNAME=value

class Program {
 public:
  // An embedded stage file: Program(device, "stages/shade.cl", {{"LANES", 16}}). Throws Error with the build log.
  Program(const Device &device, const std::string &file, const Switches &switches);
  // A text that may include embedded files (tests' probes).
  static Program from_text(const Device &device, const std::string &name, const std::string &text, const Switches &switches);

  struct State;
  State &state() const { return *state_; }

 private:
  Program() = default;
  std::shared_ptr<State> state_;
};

}  // namespace sunstone
