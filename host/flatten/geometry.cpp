// SPDX-License-Identifier: Apache-2.0
#include "flatten/geometry.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "flatten/materials.h"
#include "flatten/placement.h"
#include "flatten/shapes.h"
#include "flatten/weld.h"
#include "math/vector.h"

namespace sunstone {
namespace {

using kernel::uint;

constexpr std::size_t small_mesh = 4096;                   // triangles of all copies of a mesh together
constexpr std::size_t exact_boxes = std::size_t(1) << 26;  // vertices that are transformed, at most, for the boxes of one mesh's instances

// A primitive as it goes into the arrays once: in world space for one baked instance, or in its mesh's space.
struct Part {
  const Primitive *primitive = nullptr;
  const WeldedPrimitive *welded = nullptr;
  Placement placement;
  uint material = 0;
  uint object = 0;        // where it is baked: the number of its instance, from 1
  std::size_t range = 0;  // mesh range
  std::size_t first_vertex = 0, first_triangle = 0, triangles = 0;
};

// Does any vertex need more than position, normal and one pair of texture coordinates?
bool extras_wanted(const Scene &scene, const FlatScene &flat, const std::vector<MeshUse> &uses) {
  const bool second_set = std::any_of(flat.texture_refs.begin(), flat.texture_refs.end(), [](const auto &ref) { return ref.uv_set == 1; });
  for (std::size_t m = 0; m < scene.meshes.size(); m++)
    for (const Primitive &primitive : scene.meshes[m].primitives) {
      if (!uses[m].instances) continue;
      const bool normal_map = flat.materials[material_number(scene, primitive.material)].slot[SUN_SLOT_NORMAL] != SUN_NONE;
      if (normal_map || !primitive.colors.empty() || (second_set && !primitive.uv[1].empty())) return true;
    }
  return false;
}

// Where a tangent of our making goes as its triangle deforms: it keeps its place between the triangle's edges, and its part along the normal.
class TangentsAlong {
 public:
  TangentsAlong(const Part &part, const PrimitiveKey &key) : part_(part), key_(key), triangle_(part.welded->source.size(), 0) {
    for (std::size_t i = part.welded->indices.size(); i-- > 0;) triangle_[part.welded->indices[i]] = i / 3;
  }
  glm::dvec3 at(std::size_t vertex) const {
    const auto edges = [&](const std::vector<glm::vec3> &positions, glm::dvec3 &a, glm::dvec3 &b) {
      glm::dvec3 corner[3];
      for (std::size_t k = 0; k < 3; k++) corner[k] = glm::dvec3(positions[part_.welded->source[part_.welded->indices[3 * triangle_[vertex] + k]]]);
      a = corner[1] - corner[0];
      b = corner[2] - corner[0];
      return glm::cross(a, b);
    };
    glm::dvec3 a, b, to_a, to_b;
    const glm::dvec3 n = edges(part_.primitive->positions, a, b), to_n = edges(key_.positions, to_a, to_b), t(part_.welded->tangents[vertex]);
    const double size = glm::dot(n, n);
    if (!(size > 0)) return t;
    return to_a * (glm::dot(glm::cross(t, b), n) / size) + to_b * (glm::dot(glm::cross(a, t), n) / size) + to_n * (glm::dot(t, n) / size);
  }

 private:
  const Part &part_;
  const PrimitiveKey &key_;
  std::vector<std::size_t> triangle_;
};

glm::dvec3 apply_linear(const double *m, const glm::vec3 &v) {
  const auto row = [&](const double *r) { return (r[0] * v.x + r[1] * v.y) + r[2] * v.z; };
  return {row(m), row(m + 3), row(m + 6)};
}

// Those of the shutter's key `key`, so many vertices behind those of key 0.
void write_vertices(const Part &part, FlatScene &flat, bool extras, std::size_t key) {
  const Primitive &primitive = *part.primitive;
  const WeldedPrimitive &welded = *part.welded;
  const Placement &p = part.placement;
  const PrimitiveKey *const later = key && !primitive.keys.empty() ? &primitive.keys[key - 1] : nullptr;
  const std::vector<glm::vec3> &positions = later ? later->positions : primitive.positions;
  const bool flat_faces = !primitive.keys.empty() && primitive.normals.empty();  // which turn as they deform: the kernels take the triangle's own normal
  const bool given_tangents = !primitive.tangents.empty();
  std::optional<TangentsAlong> along;
  if (later && extras && !given_tangents && !welded.tangents.empty()) along.emplace(part, *later);
  const std::size_t first = part.first_vertex + key * flat.deforming;
  for (std::size_t i = 0; i < welded.source.size(); i++) {
    const std::uint32_t source = welded.source[i];
    const glm::vec3 &local = positions[source];
    const glm::vec3 position = transform_point(p.m, local.x, local.y, local.z);
    const glm::vec3 own = later && !flat_faces ? later->normals[source] : welded.normals[i];
    const glm::vec3 normal = flat_faces ? glm::vec3(0) : unit_vector(apply_linear(p.normal, own));
    kernel::Vertex vertex{};
    for (int c = 0; c < 3; c++) {
      vertex.position[c] = position[c];
      vertex.normal[c] = normal[c];
    }
    if (!primitive.uv[0].empty()) {
      vertex.u = primitive.uv[0][source].x;
      vertex.v = primitive.uv[0][source].y;
    }
    flat.vertices[first + i] = vertex;
    if (!extras) continue;
    kernel::VertexExtra extra{};
    if (!welded.tangents.empty() && welded.tangents[i].w != 0) {
      const glm::vec4 &tangent = welded.tangents[i];
      double linear[9];
      for (int k = 0; k < 9; k++) linear[k] = p.m[4 * (k / 3) + k % 3];
      const glm::vec3 moved = along ? unit_vector(along->at(i)) : later ? glm::vec3(later->tangents[source]) : glm::vec3(tangent);
      const glm::vec3 world = unit_vector(apply_linear(linear, moved));
      for (int c = 0; c < 3; c++) extra.tangent[c] = world[c];
      extra.tangent[3] = p.mirrored() ? -tangent.w : tangent.w;  // a mirror turns the cross product over
    }
    for (int c = 0; c < 4; c++) extra.color[c] = primitive.colors.empty() ? 1.0f : primitive.colors[source][c];
    if (!primitive.uv[1].empty()) {
      extra.uv1[0] = primitive.uv[1][source].x;
      extra.uv1[1] = primitive.uv[1][source].y;
    }
    flat.vertex_extras[first + i] = extra;
  }
}

// A baked triangle may lose its area, or leave the range of numbers, on its way to world space.
bool kept(const FlatScene &flat, const Part &part, std::size_t triangle) {
  glm::vec3 corner[3];
  for (std::size_t k = 0; k < 3; k++) {
    const float *position = flat.vertices[part.first_vertex + part.welded->indices[3 * triangle + k]].position;
    corner[k] = {position[0], position[1], position[2]};
    for (int c = 0; c < 3; c++)
      if (!(std::fabs(corner[k][c]) <= farthest)) return false;
  }
  return !part.primitive->keys.empty() || triangle_cross(corner[0], corner[1], corner[2]) != glm::dvec3(0);
}

void write_triangles(const Part &part, FlatScene &flat) {
  const kernel::Material &material = flat.materials[part.material];
  uint bits = 0;
  if (single_sided(material)) bits |= SUN_ID_SINGLE_SIDED;
  if (material.flags & SUN_MATERIAL_PASSABLE) bits |= SUN_ID_PASSABLE;
  std::size_t to = part.first_triangle;
  const auto &indices = part.welded->indices;
  for (std::size_t t = 0; 3 * t < indices.size(); t++) {
    if (!kept(flat, part, t)) continue;
    kernel::Triangle triangle{};
    for (std::size_t k = 0; k < 3; k++) {
      // The winding of a mirrored triangle is turned, so that its front stays its front.
      const std::size_t from = part.placement.mirrored() && k > 0 ? 3 - k : k;
      triangle.vertex[k] = static_cast<uint>(part.first_vertex + indices[3 * t + from]);
    }
    triangle.material = part.material;
    flat.triangles[to] = triangle;
    flat.triangle_ids[to] = static_cast<uint>(to) | bits;
    flat.triangle_object[to] = part.object;
    to++;
  }
}

const float *position_at(const FlatScene &flat, const MeshRange &range, uint vertex, std::size_t key) {
  return flat.vertices[vertex + (range.deforms ? key * flat.deforming : 0)].position;
}

// The box of a range's vertices that triangles use, at all keys.
Bounds range_bounds(const FlatScene &flat, const MeshRange &range) {
  Bounds box;
  for (std::size_t t = range.first_triangle; t < std::size_t(range.first_triangle) + range.triangle_count; t++)
    for (uint v : flat.triangles[t].vertex)
      for (std::size_t key = 0; key <= (range.deforms ? flat.motion_steps : 0); key++)
        for (int c = 0; c < 3; c++) {
          const float x = position_at(flat, range, v, key)[c];
          box.lower[c] = std::min(box.lower[c], x);
          box.upper[c] = std::max(box.upper[c], x);
        }
  return box;
}

// A box that contains every transformed vertex, and hits found in mesh space: these are off by rounding errors of the order of the terms that were
// added. Of vertices that deform: at the keys from `first` to `last`.
Bounds world_box(const FlatScene &flat, const MeshRange &range, const Bounds &local, const float *m, bool exact, std::size_t first, std::size_t last) {
  Bounds box;
  const auto include = [&](const glm::vec3 &point) {
    for (int c = 0; c < 3; c++) {
      box.lower[c] = std::min(box.lower[c], point[c]);
      box.upper[c] = std::max(box.upper[c], point[c]);
    }
  };
  if (exact) {
    for (std::size_t t = range.first_triangle; t < std::size_t(range.first_triangle) + range.triangle_count; t++)
      for (uint v : flat.triangles[t].vertex)
        for (std::size_t key = first; key <= (range.deforms ? last : first); key++) {
          const float *p = position_at(flat, range, v, key);
          include(transform_point(m, p[0], p[1], p[2]));
        }
  } else {
    // Rounding is monotone, so the corners' transforms bound every vertex's.
    for (int corner = 0; corner < 8; corner++)
      include(transform_point(m, corner & 1 ? local.upper.x : local.lower.x, corner & 2 ? local.upper.y : local.lower.y,
                    corner & 4 ? local.upper.z : local.lower.z));
  }
  for (int r = 0; r < 3; r++) {
    float terms = std::fabs(m[4 * r + 3]);
    for (int c = 0; c < 3; c++) terms += std::fabs(m[4 * r + c]) * std::max(std::fabs(local.lower[c]), std::fabs(local.upper[c]));
    const float pad = terms * 0x1p-19f;
    box.lower[r] -= pad;
    box.upper[r] += pad;
  }
  return box;
}

void number_emitters(FlatScene &flat) {
  flat.triangle_emitter.assign(flat.triangles.size(), SUN_NONE);
  for (const MeshRange &range : flat.meshes) {
    uint next = 0;
    for (std::size_t t = range.first_triangle; t < std::size_t(range.first_triangle) + range.triangle_count; t++)
      if (flat.materials[flat.triangles[t].material].flags & SUN_MATERIAL_EMISSIVE) flat.triangle_emitter[t] = next++;
  }
}

// The instances of the mesh ranges: the identity for what was baked, then those of the meshes kept in their own space, in the scene's order.
void write_instances(const Scene &scene, const std::vector<MeshUse> &uses, const std::vector<std::size_t> &range_of_mesh, bool any_baked,
                     FlatScene &flat, Notices &notices) {
  std::vector<std::vector<kernel::InstanceKey>> keys;
  const auto add = [&](const Placement &p, std::size_t range, std::size_t object, std::vector<kernel::InstanceKey> own_keys) {
    kernel::Instance instance = instance_at(p);
    if (flat.meshes[range].deforms) instance.flags |= SUN_INSTANCE_DEFORMING;
    keys.push_back(std::move(own_keys));
    flat.instances.push_back(instance);
    flat.instance_mesh.push_back(static_cast<uint>(range));
    flat.instance_object.push_back(static_cast<uint>(object));
  };
  if (any_baked && flat.meshes[0].triangle_count) {
    add({}, 0, 0, {});
    flat.instances[0].flags = SUN_INSTANCE_IDENTITY;
  }
  for (std::size_t i = 0; i < scene.instances.size(); i++) {
    const auto mesh = static_cast<std::size_t>(scene.instances[i].mesh);
    if (!uses[mesh].baked && flat.meshes[range_of_mesh[mesh]].triangle_count)
      add(placement_of(scene.instances[i].transform), range_of_mesh[mesh], i + 1, keys_of(scene.instances[i].transform, scene.instances[i].keys));
  }

  std::vector<Bounds> local(flat.meshes.size()), boxes(flat.instances.size());
  tbb::parallel_for(std::size_t(0), local.size(), [&](std::size_t i) { local[i] = range_bounds(flat, flat.meshes[i]); });
  std::vector<std::size_t> copies(flat.meshes.size());
  for (uint mesh : flat.instance_mesh) copies[mesh]++;
  tbb::parallel_for(std::size_t(0), boxes.size(), [&](std::size_t i) {
    const uint mesh = flat.instance_mesh[i];
    const MeshRange &range = flat.meshes[mesh];
    const bool identity = flat.instances[i].flags & SUN_INSTANCE_IDENTITY;
    const std::size_t times = (range.deforms ? 3 : 1) * std::max<std::size_t>(1, keys[i].size());
    const bool exact = copies[mesh] * (3 * std::size_t(range.triangle_count)) * times <= exact_boxes;
    if (identity) boxes[i] = local[mesh];
    // Within a step places are a mean of what the matrix of either key makes of the vertex of either key.
    for (std::size_t key = 0; key < keys[i].size(); key++)
      include_box(boxes[i], world_box(flat, range, local[mesh], keys[i][key].to_world, exact, key ? key - 1 : 0, std::min<std::size_t>(key + 1, flat.motion_steps)));
    if (!identity && keys[i].empty()) boxes[i] = world_box(flat, range, local[mesh], flat.instances[i].to_world, exact, 0, range.deforms ? flat.motion_steps : 0);
  });

  std::size_t to = 0, far = 0;
  for (std::size_t i = 0; i < boxes.size(); i++) {
    if (!in_range(boxes[i]) || (keys[i].empty() && !has_inverse(flat.instances[i]))) {
      far++;
      continue;
    }
    kernel::Instance instance = flat.instances[i];
    take_keys(keys[i], instance, flat);
    for (int c = 0; c < 3; c++) {
      instance.lower[c] = boxes[i].lower[c];
      instance.upper[c] = boxes[i].upper[c];
      flat.bounds.lower[c] = std::min(flat.bounds.lower[c], instance.lower[c]);
      flat.bounds.upper[c] = std::max(flat.bounds.upper[c], instance.upper[c]);
    }
    flat.instances[to] = instance;
    flat.instance_mesh[to] = flat.instance_mesh[i];
    flat.instance_object[to++] = flat.instance_object[i];
  }
  flat.instances.resize(to);
  flat.instance_mesh.resize(to);
  flat.instance_object.resize(to);
  if (far)
    notices.warning(scene.name, std::to_string(far) + " instances lie beyond 1e18 m or cannot be inverted in single precision; they are left out");
}

void check_size(const char *what, std::size_t count, std::size_t size, std::size_t max_bytes) {
  if (count > max_bytes / size)
    throw Error{"flatten", std::to_string(count) + " " + what + " do not fit into one buffer of " + std::to_string(max_bytes >> 20) + " MiB",
                "use a device whose largest buffer is larger, or a simpler scene"};
}

}  // namespace

std::vector<MeshUse> mesh_uses(const Scene &scene) {
  std::vector<MeshUse> uses(scene.meshes.size());
  std::vector<bool> moves(scene.meshes.size());
  for (const Instance &instance : scene.instances) {
    uses[static_cast<std::size_t>(instance.mesh)].instances++;
    if (!instance.keys.empty()) moves[static_cast<std::size_t>(instance.mesh)] = true;
  }
  for (std::size_t m = 0; m < uses.size(); m++) {
    for (const Primitive &primitive : scene.meshes[m].primitives) uses[m].triangles += primitive.indices.size() / 3;
    uses[m].baked = (uses[m].instances == 1 || uses[m].instances * uses[m].triangles <= small_mesh) && !moves[m] && !scene.meshes[m].deforms();
  }
  return uses;
}

bool needs_tangents(const Scene &scene, const Primitive &primitive) {
  if (primitive.material < 0) return false;
  const Material &material = scene.materials[static_cast<std::size_t>(primitive.material)];
  const TextureUse &use = material.normal_texture;
  return !material.unlit && use && scene.textures[static_cast<std::size_t>(use.texture)].image >= 0;
}

void flatten_geometry(const Scene &scene, std::size_t max_bytes, FlatScene &flat, Notices &notices) {
  const std::vector<MeshUse> uses = mesh_uses(scene);

  // Every primitive that is shown, once, with its attributes.
  std::vector<std::vector<WeldedPrimitive>> welded(scene.meshes.size());
  std::vector<std::pair<std::size_t, std::size_t>> work;
  for (std::size_t m = 0; m < scene.meshes.size(); m++) {
    if (!uses[m].instances) continue;
    welded[m].resize(scene.meshes[m].primitives.size());
    for (std::size_t k = 0; k < welded[m].size(); k++) work.emplace_back(m, k);
  }
  tbb::parallel_for(std::size_t(0), work.size(), [&](std::size_t i) {
    const auto [m, k] = work[i];
    const Primitive &primitive = scene.meshes[m].primitives[k];
    const bool tangents = needs_tangents(scene, primitive);
    const int uv_set = tangents && scene.materials[static_cast<std::size_t>(primitive.material)].normal_texture.uv_set == 1 ? 1 : 0;
    welded[m][k] = weld(primitive, tangents, uv_set);
  });

  // Where each goes: what is baked first, instance by instance, then the other meshes.
  std::vector<Part> parts;
  std::vector<std::size_t> range_of_mesh(scene.meshes.size());
  const auto add_parts = [&](std::size_t m, const Placement &placement, std::size_t object, std::size_t range) {
    for (std::size_t k = 0; k < welded[m].size(); k++) {
      const Primitive &primitive = scene.meshes[m].primitives[k];
      parts.push_back({&primitive, &welded[m][k], placement, material_number(scene, primitive.material), static_cast<uint>(object), range, 0, 0, 0});
    }
  };
  for (std::size_t i = 0; i < scene.instances.size(); i++)
    if (const auto m = static_cast<std::size_t>(scene.instances[i].mesh); uses[m].baked)
      add_parts(m, placement_of(scene.instances[i].transform), i + 1, 0);
  const bool any_baked = !parts.empty();
  std::size_t ranges = any_baked ? 1 : 0;
  // What deforms stands last.
  for (const bool deforms : {false, true})
    for (std::size_t m = 0; m < uses.size(); m++)
      if (uses[m].instances && !uses[m].baked && scene.meshes[m].deforms() == deforms) {
        range_of_mesh[m] = ranges;
        add_parts(m, {}, 0, ranges++);
        flat.meshes.resize(ranges);
        flat.meshes.back().deforms = deforms;
      }

  std::size_t vertices = 0, deforming = 0;
  for (Part &part : parts) {
    part.first_vertex = vertices;
    vertices += part.welded->source.size();
    if (part.range < flat.meshes.size() && flat.meshes[part.range].deforms) deforming += part.welded->source.size();
  }
  vertices += flat.motion_steps * deforming;
  check_size("vertices", vertices, sizeof(kernel::Vertex), max_bytes);
  if (vertices >= SUN_NONE) throw Error{"flatten", "more than 2^32 vertices"};
  flat.deforming = static_cast<uint>(deforming);
  const bool extras = extras_wanted(scene, flat, uses);
  flat.has_textures = flat.has_textures || extras;
  if (extras) check_size("vertices with tangents or colours", vertices, sizeof(kernel::VertexExtra), max_bytes);
  flat.vertices.resize(vertices);
  flat.vertex_extras.resize(extras ? vertices : 1);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    const bool deforms = parts[i].range < flat.meshes.size() && flat.meshes[parts[i].range].deforms;
    for (std::size_t key = 0; key <= (deforms ? flat.motion_steps : 0); key++) write_vertices(parts[i], flat, extras, key);
    for (std::size_t t = 0; 3 * t < parts[i].welded->indices.size(); t++) parts[i].triangles += kept(flat, parts[i], t);
  });

  std::size_t triangles = 0, dropped = 0;
  flat.meshes.resize(ranges);
  for (Part &part : parts) {
    part.first_triangle = triangles;
    if (!flat.meshes[part.range].triangle_count) flat.meshes[part.range].first_triangle = static_cast<uint>(triangles);
    triangles += part.triangles;
    dropped += part.welded->dropped + (part.welded->indices.size() / 3 - part.triangles);
    if (triangles > SUN_ID_PRIMITIVE) throw Error{"flatten", "more than 2^29 triangles", "use a simpler scene"};
    flat.meshes[part.range].triangle_count += static_cast<uint>(part.triangles);
  }
  check_size("triangles", triangles, sizeof(kernel::Triangle), max_bytes);
  flat.triangles.resize(triangles);
  flat.triangle_ids.resize(triangles);
  flat.triangle_object.resize(triangles);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) { write_triangles(parts[i], flat); });
  if (dropped) notices.note(scene.name, std::to_string(dropped) + " triangles without area are left out");

  write_instances(scene, uses, range_of_mesh, any_baked, flat, notices);
  if (triangles + scene.shapes.size() > SUN_ID_PRIMITIVE) throw Error{"flatten", "more than 2^29 triangles and shapes", "use a simpler scene"};
  write_shapes(scene, false, extras, flat, notices);
  if (flat.instances.empty()) {  // nothing to show: an identity of an empty range, at the end of the triangles
    kernel::Instance instance{};
    for (int i = 0; i < 3; i++) instance.to_world[5 * i] = instance.to_object[5 * i] = 1;
    instance.flags = SUN_INSTANCE_IDENTITY;
    instance.first_emitter = SUN_NONE;
    flat.meshes.push_back({static_cast<uint>(triangles), 0});
    flat.instances.push_back(instance);
    flat.instance_mesh.push_back(static_cast<uint>(flat.meshes.size() - 1));
    flat.instance_object.push_back(0);
  }
  write_shapes(scene, true, extras, flat, notices);
  number_emitters(flat);
  if (flat.bounds.empty()) {
    flat.bounds.lower = glm::vec3(-1);
    flat.bounds.upper = glm::vec3(1);
  }
}

}  // namespace sunstone
