// SPDX-License-Identifier: Apache-2.0
#include "flatten/shapes.h"

#include <algorithm>
#include <cmath>

#include "flatten/materials.h"
#include "flatten/placement.h"

namespace sunstone {
namespace {

using kernel::uint;

uint kind_bit(Shape::Kind kind) {
  switch (kind) {
    case Shape::Kind::sphere: return SUN_INSTANCE_SPHERE;
    case Shape::Kind::disk: return SUN_INSTANCE_DISK;
    case Shape::Kind::quad: return SUN_INSTANCE_QUAD;
    case Shape::Kind::plane: return SUN_INSTANCE_PLANE;
  }
  return 0;
}

// The world box of a shape, with the margin of world_box.
Bounds shape_box(const float *m, Shape::Kind kind) {
  Bounds box;
  for (int r = 0; r < 3; r++) {
    const float x = std::fabs(m[4 * r]), y = std::fabs(m[4 * r + 1]), z = std::fabs(m[4 * r + 2]), center = m[4 * r + 3];
    const float reach = kind == Shape::Kind::quad   ? x + z
                        : kind == Shape::Kind::disk ? std::sqrt(x * x + z * z)
                                                    : std::sqrt((x * x + y * y) + z * z);
    const float pad = (std::fabs(center) + ((x + y) + z)) * 0x1p-19f;
    box.lower[r] = (center - reach) - pad;
    box.upper[r] = (center + reach) + pad;
  }
  return box;
}

// Nothing off the diagonal but the place.
bool aligned(const float *m) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      if (row != column && m[4 * row + column] != 0) return false;
  return true;
}

}  // namespace

void write_shapes(const Scene &scene, bool planes, bool extras, FlatScene &flat, Notices &notices) {
  std::size_t far = 0;
  for (std::size_t i = 0; i < scene.shapes.size(); i++) {
    const Shape &shape = scene.shapes[i];
    if ((shape.kind == Shape::Kind::plane) != planes) continue;
    const Placement p = placement_of(shape.transform);
    kernel::Instance instance = instance_at(p);
    const std::vector<kernel::InstanceKey> keys = keys_of(shape.transform, shape.keys);
    Bounds box = planes ? Bounds{glm::vec3(0), glm::vec3(0)} : shape_box(p.m, shape.kind);
    for (const kernel::InstanceKey &key : keys)
      if (!planes) include_box(box, shape_box(key.to_world, shape.kind));
    if (!in_range(box) || !has_inverse(instance)) {
      far++;
      continue;
    }
    const uint material = material_number(scene, shape.material);
    instance.flags |= kind_bit(shape.kind);
    if (aligned(instance.to_world) && aligned(instance.to_object)) {
      instance.flags |= SUN_INSTANCE_ALIGNED;
      const float *m = instance.to_world;
      if (shape.kind == Shape::Kind::sphere && keys.empty() && m[0] == m[5] && m[0] == m[10]) instance.flags |= SUN_INSTANCE_ROUND;
    }
    if (single_sided(flat.materials[material])) instance.flags |= SUN_INSTANCE_SINGLE_SIDED;
    if (flat.materials[material].flags & SUN_MATERIAL_PASSABLE) instance.flags |= SUN_INSTANCE_PASSABLE;
    take_keys(keys, instance, flat);
    for (int c = 0; c < 3; c++) {
      instance.lower[c] = box.lower[c];
      instance.upper[c] = box.upper[c];
      if (planes) continue;
      flat.bounds.lower[c] = std::min(flat.bounds.lower[c], box.lower[c]);
      flat.bounds.upper[c] = std::max(flat.bounds.upper[c], box.upper[c]);
    }
    const auto vertex = static_cast<uint>(flat.vertices.size()), primitive = static_cast<uint>(flat.triangles.size());
    kernel::Vertex corner{};
    corner.normal[1] = 1;
    flat.vertices.push_back(corner);
    if (extras) flat.vertex_extras.push_back({});
    flat.triangles.push_back({{vertex, vertex, vertex}, material});
    flat.triangle_ids.push_back(primitive);
    flat.triangle_object.push_back(0);
    flat.instance_mesh.push_back(static_cast<uint>(flat.meshes.size()));
    flat.meshes.push_back({primitive, 1});
    flat.instances.push_back(instance);
    flat.instance_object.push_back(static_cast<uint>(scene.instances.size() + i + 1));
    flat.shape_count++;
    flat.plane_count += planes;
  }
  if (far) notices.warning(scene.name, std::to_string(far) + " shapes lie beyond 1e18 m or cannot be inverted in single precision; they are left out");
}

}  // namespace sunstone
