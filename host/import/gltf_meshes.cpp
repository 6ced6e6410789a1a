// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_meshes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "import/gltf_skins.h"

namespace sunstone::gltf {

namespace {

enum class Mode { triangles = 4, strip = 5, fan = 6 };

// The unit vector along v, by exactly rounded operations alone (glm::normalize takes a reciprocal); nothing where v has no direction.
// Doubles, so that the squares of floats neither overflow nor vanish.
std::optional<glm::vec3> unit(const glm::dvec3 &v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return glm::vec3(static_cast<float>(v.x / length), static_cast<float>(v.y / length), static_cast<float>(v.z / length));
}

// Triangles out of a row of vertex numbers, wound as glTF 2.0, section 3.7.2.1 says.
std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t> &row, Mode mode) {
  if (row.size() < 3) return {};
  if (mode == Mode::triangles) return {row.begin(), row.end() - static_cast<std::ptrdiff_t>(row.size() % 3)};
  std::vector<std::uint32_t> out;
  out.reserve((row.size() - 2) * 3);
  for (std::size_t i = 0; i + 2 < row.size(); i++) {
    if (mode == Mode::strip)
      out.insert(out.end(), {row[i], row[i + 1 + i % 2], row[i + 2 - i % 2]});
    else
      out.insert(out.end(), {row[i + 1], row[i + 2], row[0]});
  }
  return out;
}

// Normals are made unit; those without a direction get that of the triangles around them.
void repair_normals(const Value &value, Primitive &primitive) {
  std::vector<bool> broken(primitive.normals.size(), false);
  bool any = false;
  for (std::size_t i = 0; i < broken.size(); i++) {
    const std::optional<glm::vec3> normal = unit(glm::dvec3(primitive.normals[i]));
    primitive.normals[i] = normal.value_or(glm::vec3(0));
    if (!normal) any = broken[i] = true;
  }
  if (!any) return;
  value.warn("normals without a direction were replaced by those of the faces");
  const auto &p = primitive.positions;
  for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
    const std::uint32_t *corner = &primitive.indices[t];
    if (!broken[corner[0]] && !broken[corner[1]] && !broken[corner[2]]) continue;
    const glm::dvec3 origin(p[corner[0]]);
    const std::optional<glm::vec3> normal = unit(glm::cross(glm::dvec3(p[corner[1]]) - origin, glm::dvec3(p[corner[2]]) - origin));
    if (!normal) continue;
    for (int k = 0; k < 3; k++)
      if (broken[corner[k]]) primitive.normals[corner[k]] += *normal;
  }
  for (std::size_t i = 0; i < broken.size(); i++)
    if (broken[i]) primitive.normals[i] = unit(glm::dvec3(primitive.normals[i])).value_or(glm::vec3(0, 0, 1));  // of no triangle that could be seen
}

void repair_tangents(const Value &value, Primitive &primitive) {
  for (glm::vec4 &tangent : primitive.tangents) {
    const std::optional<glm::vec3> direction = unit(glm::dvec3(tangent));
    if (!direction || std::isnan(tangent.w)) {
      value.warn("tangents without a direction: they are made anew from the texture coordinates");
      primitive.tangents.clear();
      return;
    }
    tangent = glm::vec4(*direction, tangent.w < 0 ? -1.0f : 1.0f);
  }
}

template <class Vector>
void replace_not_finite(const Value &value, std::vector<Vector> &values) {
  bool found = false;
  for (Vector &v : values)
    for (int c = 0; c < Vector::length(); c++)
      if (!std::isfinite(v[c])) v[c] = 0, found = true;
  if (found) value.warn("numbers that are not finite were replaced by 0");
}

// Adds weight * delta to as many values as there are.
template <class Vector>
void add_scaled(std::vector<Vector> &values, const std::vector<glm::vec3> &deltas, float weight) {
  for (std::size_t i = 0; i < values.size(); i++)
    for (int c = 0; c < 3; c++) values[i][c] += weight * deltas[i][c];
}

// Morph targets, each read when a weight asks for it.
class MorphTargets {
 public:
  MorphTargets(const Value &targets, Accessors &accessors) : targets_(targets), accessors_(accessors), read_(targets.size()) {}

  void apply(const std::vector<double> &weights, Primitive &primitive) {
    if (targets_.size() == 0) return;
    if (!weights.empty() && weights.size() != targets_.size())
      targets_.fail("there are " + counted(targets_.size(), "targets") + ", but " + counted(weights.size(), "weights"));
    for (std::size_t t = 0; t < weights.size(); t++) {
      const float weight = static_cast<float>(weights[t]);
      if (weight == 0) continue;
      if (!read_[t]) read_[t] = read(targets_[t], primitive);
      if (!read_[t]->positions.empty()) add_scaled(primitive.positions, read_[t]->positions, weight);
      if (!read_[t]->normals.empty()) add_scaled(primitive.normals, read_[t]->normals, weight);
      if (!read_[t]->tangents.empty()) add_scaled(primitive.tangents, read_[t]->tangents, weight);
    }
  }

 private:
  struct Deltas {
    std::vector<glm::vec3> positions, normals, tangents;
  };
  Deltas read(const Value &target, const Primitive &primitive) {
    target.expect_object();
    const auto deltas = [&](const Value &attribute) {
      const Accessor accessor = accessors_.open(attribute, 3);
      if (accessor.count != primitive.positions.size())
        attribute.fail("has " + counted(accessor.count, "elements") + ", but there are " + counted(primitive.positions.size(), "positions"));
      return accessors_.floats<3>(accessor);
    };
    Deltas all;
    if (const Value position = target["POSITION"]) all.positions = deltas(position);
    if (const Value normal = target["NORMAL"]; normal && !primitive.normals.empty()) all.normals = deltas(normal);
    if (const Value tangent = target["TANGENT"]; tangent && !primitive.tangents.empty()) all.tangents = deltas(tangent);
    for (const char *other : {"TEXCOORD_0", "TEXCOORD_1", "COLOR_0"})
      if (target[other]) target[other].warn("texture coordinates and colours are not morphed");
    return all;
  }

  Value targets_;
  Accessors &accessors_;
  std::vector<std::optional<Deltas>> read_;
};

}  // namespace

void Meshes::read_attributes(const Value &value, Primitive &primitive) {
  const Value attributes = value["attributes"];
  const bool draco = static_cast<bool>(value.extension("KHR_draco_mesh_compression"));
  const auto open = [&](const Value &attribute, int components) {
    const Accessor accessor = accessors_.open(attribute, components);
    if (draco && !accessor.backed && !accessor.sparse) value.fail("its data is there by KHR_draco_mesh_compression alone, which is not supported");
    return accessor;
  };
  primitive.positions = accessors_.floats<3>(open(attributes["POSITION"], 3));

  // Every other attribute has to have as many elements, which is asked before they are read.
  const auto open_beside = [&](const Value &attribute, int components) {
    const Accessor accessor = open(attribute, components);
    if (accessor.count != primitive.positions.size())
      attribute.fail("has " + counted(accessor.count, "elements") + ", but there are " + counted(primitive.positions.size(), "positions"));
    return accessor;
  };
  if (const Value normal = attributes["NORMAL"]) primitive.normals = accessors_.floats<3>(open_beside(normal, 3));
  if (const Value tangent = attributes["TANGENT"]) primitive.tangents = accessors_.floats<4>(open_beside(tangent, 4));
  const char *const sets[2] = {"TEXCOORD_0", "TEXCOORD_1"};
  for (int set = 0; set < 2; set++) {
    if (const Value uv = attributes[sets[set]]) {
      primitive.uv[set] = accessors_.floats<2>(open_beside(uv, 2));
      replace_not_finite(uv, primitive.uv[set]);
    }
  }
  if (const Value color = attributes["COLOR_0"]) {
    const Accessor accessor = open_beside(color, 0);
    if (accessor.components == 4) {
      primitive.colors = accessors_.floats<4>(accessor);
    } else if (accessor.components == 3) {
      const std::vector<glm::vec3> rgb = accessors_.floats<3>(accessor);
      accessors_.budget().take(rgb.size(), sizeof(glm::vec4), color);
      primitive.colors.reserve(rgb.size());
      for (const glm::vec3 &c : rgb) primitive.colors.emplace_back(c, 1.0f);
    } else {
      color.fail("a colour has 3 or 4 components, not " + std::to_string(accessor.components));
    }
    replace_not_finite(color, primitive.colors);
  }
}

void Meshes::read_indices(const Value &value, Primitive &primitive) {
  const Mode mode = static_cast<Mode>(value["mode"].whole(4));
  std::vector<std::uint32_t> row;
  if (const Value reference = value["indices"]) {
    const Accessor accessor = accessors_.open(reference, 1);
    if (!accessor.backed && !accessor.sparse && value.extension("KHR_draco_mesh_compression"))
      value.fail("its data is there by KHR_draco_mesh_compression alone, which is not supported");
    row = accessors_.indices(accessor);
    for (const std::uint32_t index : row)
      if (index >= primitive.positions.size())
        reference.fail("index " + std::to_string(index) + ", but there are " + counted(primitive.positions.size(), "vertices"));
  } else {
    accessors_.budget().take(primitive.positions.size(), sizeof(std::uint32_t), value);
    row.resize(primitive.positions.size());
    for (std::size_t i = 0; i < row.size(); i++) row[i] = static_cast<std::uint32_t>(i);
  }
  if (mode == Mode::triangles && row.size() % 3 != 0)
    value.warn(counted(row.size(), "vertices") + " are no whole number of triangles: the last " + (row.size() % 3 == 1 ? "one was" : "two were") +
               " ignored");
  accessors_.budget().take(row.size(), mode == Mode::triangles ? sizeof(std::uint32_t) : 3 * sizeof(std::uint32_t), value);
  primitive.indices = triangles_of(row, mode);
}

bool Meshes::read_primitive(const Value &value, const std::vector<MeshPose> &poses, Primitive &primitive) {
  value.expect_object();
  value.check_extensions({"KHR_draco_mesh_compression"});
  const Value mode = value["mode"];
  const std::uint64_t number = mode.whole(4);
  if (number > 6) mode.fail(std::to_string(number) + " is no mode: 0 to 6");
  if (number < 4) {
    value.context().report.warning(value.full_place(), number == 0 ? "points are not rendered" : "lines are not rendered");
    return false;
  }
  const Value attributes = value["attributes"];
  attributes.expect_object();
  if (!attributes["POSITION"]) {
    value.warn("has no POSITION and was skipped");
    return false;
  }
  if (value.extension("KHR_draco_mesh_compression"))
    value.context().report.once(value.context().file, "KHR_draco_mesh_compression is not supported: the uncompressed data is read instead");
  read_attributes(value, primitive);
  const Primitive stored = poses.size() > 1 ? primitive : Primitive{};
  MorphTargets targets(value["targets"], accessors_);
  targets.apply(*poses[0].weights, primitive);
  read_indices(value, primitive);
  if (primitive.indices.empty()) {
    value.warn("has no triangle and was skipped");
    return false;
  }
  Influences influences;
  if (poses[0].joints) influences = read_influences(attributes, primitive.positions.size(), accessors_);
  const std::vector<std::uint32_t> indices = poses.size() > 1 ? primitive.indices : std::vector<std::uint32_t>{};
  const auto finish = [&](const MeshPose &pose, Primitive &posed) {
    if (pose.joints) apply_skin(attributes, influences, *pose.joints, posed);
    repair_normals(attributes["NORMAL"], posed);
    repair_tangents(attributes["TANGENT"], posed);
  };
  finish(poses[0], primitive);
  // The triangles, and which of them a mirror turns, are those of the first pose.
  for (std::size_t key = 1; key < poses.size(); key++) {
    accessors_.budget().take(stored.positions.size(), 2 * sizeof(glm::vec3) + (stored.tangents.empty() ? 0 : sizeof(glm::vec4)), value);
    Primitive posed;
    posed.positions = stored.positions;
    posed.normals = stored.normals;
    posed.tangents = stored.tangents;
    posed.indices = indices;
    targets.apply(*poses[key].weights, posed);
    finish(poses[key], posed);
    primitive.keys.push_back({std::move(posed.positions), std::move(posed.normals), std::move(posed.tangents)});
  }
  return true;
}

Mesh Meshes::read(const Value &value, const std::vector<MeshPose> &poses, Scene &scene) {
  const Value primitives = value["primitives"];
  if (primitives.size() == 0) primitives.fail(primitives ? "is empty" : "is missing");
  Mesh mesh;
  mesh.name = value["name"].text();
  for (std::size_t i = 0; i < primitives.size(); i++) {
    Primitive primitive;
    if (!read_primitive(primitives[i], poses, primitive)) continue;
    primitive.material = materials_.material(primitives[i]["material"], scene);
    mesh.primitives.push_back(std::move(primitive));
  }
  return mesh;
}

int Meshes::mesh(const Value &node, std::vector<MeshPose> poses, Scene &scene) {
  const std::size_t index = node["mesh"].index(meshes_.size(), "meshes");
  const Value value = meshes_[index];
  value.expect_object();
  const Value weights_value = node["weights"] ? node["weights"] : value["weights"];
  std::vector<double> all_weights;
  for (MeshPose &pose : poses) {
    if (!pose.weights) {
      pose.weights = weights_value.numbers(weights_value.size());
      for (std::size_t i = 0; i < pose.weights->size(); i++) weights_value[i].real(0);
    }
    all_weights.insert(all_weights.end(), pose.weights->begin(), pose.weights->end());
  }
  const auto add = [&]() -> int {
    value.check_extensions({});
    Mesh mesh = read(value, poses, scene);
    if (mesh.primitives.empty()) return -1;
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size()) - 1;
  };
  if (poses[0].joints) return add();
  const auto [found, is_new] = numbers_.try_emplace({index, all_weights}, -1);
  if (is_new) found->second = add();
  return found->second;
}

}  // namespace sunstone::gltf
