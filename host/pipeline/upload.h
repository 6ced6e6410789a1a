// SPDX-License-Identifier: Apache-2.0
// FlatScene -> device buffers, one set per device.
#pragma once
#include <array>

#include "device/buffer.h"
#include "flatten/flatten.h"

namespace sunstone {

struct DeviceScene {
  Buffer<std::byte> nodes, leaves;
  Buffer<kernel::uint> instance_list, roots;
  Buffer<kernel::Fragment> fragments;
  Buffer<kernel::Vertex> vertices;
  Buffer<kernel::VertexExtra> extras;
  Buffer<kernel::Triangle> triangles;
  Buffer<kernel::Instance> instances;
  Buffer<kernel::uint> records;  // all small tables, one after the other
  std::array<Buffer<kernel::uint>, SUN_TEXTURE_PAGES> pages;
  kernel::uint top_root = 0;
  std::size_t bytes = 0;
};

// Uploads, and writes into `frame` what the kernels have to know of the scene: counts, flags, and where each table begins. `filter` is the inverse cdf
// of the picture's filter. Throws Error where the device has no room, before anything is allocated.
DeviceScene upload(const Device &device, const FlatScene &scene, std::span<const float> filter, kernel::Frame &frame);

}  // namespace sunstone
