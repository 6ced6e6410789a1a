// SPDX-License-Identifier: Apache-2.0
#include "kernels/hits/tracer.h"

#include <array>
#include <cstdlib>

#include "base/error.h"
#include "flatten/bvh.h"

namespace sunstone::hits {

using kernel::uint;

std::optional<Device> test_device() {
  Notices notices;
  const std::vector<DeviceInfo> devices = list_devices(notices);
  if (devices.empty()) return std::nullopt;
  const char *chosen = std::getenv("SUNSTONE_TEST_DEVICE");
  return Device(choose_device(devices, chosen ? chosen : ""), {});
}

Tracer::Tracer(const Device &device, const FlatScene &scene, Layout layout)
    : device_(device), layout_(layout), program_(device, "stages/trace.cl", {{"SUN_LAYOUT", int(layout)}}) {
  load(scene);
}

void Tracer::load(const FlatScene &scene) {
  const Tree tree = build_tree(scene, layout_);
  nodes_ = Buffer<std::byte>(device_, std::span<const std::byte>(tree.nodes), "nodes");
  leaves_ = Buffer<std::byte>(device_, std::span<const std::byte>(tree.leaves), "leaves");
  list_ = Buffer<uint>(device_, std::span<const uint>(tree.instance_list), "instance list");
  roots_ = Buffer<uint>(device_, std::span<const uint>(tree.roots), "roots");
  fragments_ = Buffer<kernel::Fragment>(device_, std::span<const kernel::Fragment>(scene.fragments), "fragments");
  instances_ = Buffer<kernel::Instance>(device_, std::span<const kernel::Instance>(instances_with_keys(scene)), "instances");
  top_root_ = tree.top_root;
  instance_count_ = uint(scene.instances.size() - scene.plane_count);
  plane_count_ = uint(scene.plane_count);
}

template <class T>
std::vector<T> Tracer::run(const char *name, std::span<const TracedRay> rays, uint want) const {
  std::vector<TraceRay> plain;
  std::vector<std::array<uint, 2>> passed;
  for (const TracedRay &ray : rays) {
    plain.push_back(ray.ray);
    passed.push_back({ray.passed_instance, ray.passed_primitive});
  }
  const Buffer<TraceRay> ray_buffer(device_, std::span<const TraceRay>(plain), "rays");
  const Buffer<std::array<uint, 2>> passed_buffer(device_, std::span<const std::array<uint, 2>>(passed), "passed");
  const Buffer<T> result(device_, rays.size(), "result");
  Kernel kernel(program_, name);
  kernel.run(rays.size(), ray_buffer, passed_buffer, result, uint(rays.size()), want, nodes_, leaves_, list_, roots_, top_root_, fragments_, instances_,
             instance_count_, plane_count_, rays.empty() ? 0.0f : rays[0].time);
  return result.download();
}

std::vector<kernel::Hit> Tracer::closest(std::span<const TracedRay> rays, uint want) const { return run<kernel::Hit>("trace_closest", rays, want); }
std::vector<uint> Tracer::any(std::span<const TracedRay> rays, uint want) const { return run<uint>("trace_any", rays, want); }

}  // namespace sunstone::hits
