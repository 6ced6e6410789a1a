// SPDX-License-Identifier: Apache-2.0
// Traces on a device, over a tree of one layout.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "device/kernel.h"
#include "kernels/hits/brute_force.h"

namespace sunstone::hits {

// The device that tests run on: SUNSTONE_TEST_DEVICE (index, name or "cpu", as --device takes it), else the default. Empty where there is none.
std::optional<Device> test_device();

class Tracer {
 public:
  Tracer(const Device &device, const FlatScene &scene, Layout layout);
  // All rays have the time of the first.
  std::vector<kernel::Hit> closest(std::span<const TracedRay> rays, kernel::uint want = 0) const;
  std::vector<kernel::uint> any(std::span<const TracedRay> rays, kernel::uint want = 0) const;
  // Another scene, in the programs that are built already.
  void load(const FlatScene &scene);

 private:
  template <class T>
  std::vector<T> run(const char *name, std::span<const TracedRay> rays, kernel::uint want) const;
  Device device_;
  Layout layout_;
  Program program_;
  Buffer<std::byte> nodes_, leaves_;
  Buffer<kernel::uint> list_, roots_;
  Buffer<kernel::Fragment> fragments_;
  Buffer<kernel::Instance> instances_;
  kernel::uint top_root_ = 0, instance_count_ = 0, plane_count_ = 0;
};

}  // namespace sunstone::hits
