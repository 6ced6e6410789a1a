// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>

#include "flatten/flatten.h"

namespace sunstone {

std::vector<kernel::Instance> instances_with_keys(const FlatScene &scene) {
  std::vector<kernel::Instance> all = scene.instances;
  if (scene.motion_steps == 0) return all;
  const kernel::Motion motion{scene.motion_steps, scene.deforming, {0, 0}};
  // Two keys at least: lanes that do not move read some all the same.
  const std::size_t bytes = sizeof motion + std::max<std::size_t>(2, scene.instance_keys.size()) * sizeof(kernel::InstanceKey);
  const std::size_t first = all.size();
  all.resize(first + (bytes + sizeof(kernel::Instance) - 1) / sizeof(kernel::Instance), kernel::Instance{});
  std::byte *const to = reinterpret_cast<std::byte *>(all.data() + first);
  std::memcpy(to, &motion, sizeof motion);
  if (!scene.instance_keys.empty()) std::memcpy(to + sizeof motion, scene.instance_keys.data(), scene.instance_keys.size() * sizeof(kernel::InstanceKey));
  return all;
}

}  // namespace sunstone
