// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "import/gltf_skins.h"

namespace sunstone::gltf {

namespace {

constexpr double far_away = 1e30;  // beyond it products of coordinates overflow single precision
constexpr double pi = 3.14159265358979323846;

// Unit length, or nothing where there is no direction. Square root and division alone, so that every host gives the same bits.
std::optional<glm::dvec3> unit(const glm::dvec3 &v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  if (!(length > 1e-150) || !std::isfinite(length)) return {};
  return glm::dvec3(v.x / length, v.y / length, v.z / length);
}

bool usable(const glm::dmat4 &m) {
  for (int c = 0; c < 4; c++)
    for (int r = 0; r < 3; r++)
      if (!(std::fabs(m[c][r]) <= far_away)) return false;
  return true;
}

glm::mat4x3 rounded(const glm::dmat4 &m) { return {glm::vec3(m[0]), glm::vec3(m[1]), glm::vec3(m[2]), glm::vec3(m[3])}; }

std::string name_of(const Value &object, const Value &node) {
  const std::string name = object["name"].text();
  return name.empty() ? node["name"].text() : name;
}

}  // namespace

Nodes::Nodes(const Value &root, Accessors &accessors, Materials &materials, Meshes &meshes)
    : nodes_(root["nodes"]),
      cameras_(root["cameras"]),
      lights_(root.extension("KHR_lights_punctual")["lights"]),
      shapes_(root.extension("KHR_implicit_shapes")["shapes"]),
      skins_(root["skins"]),
      hierarchy_(root),
      accessors_(accessors),
      materials_(materials),
      meshes_(meshes) {}

void Nodes::import(const Animation &animation, double time, double shutter, Scene &scene) {
  for (const std::size_t node : hierarchy_.place(animation, time, shutter)) add_node(node, scene);
  scene.motion_steps = static_cast<unsigned>(hierarchy_.keys() - 1);
}

std::optional<Joints> Nodes::joints_of(const Value &node, std::size_t key) {
  const Value reference = node["skin"];
  if (!reference) return {};
  const Value skin = skins_[reference.index(skins_.size(), "skins")];
  const std::vector<std::size_t> numbers = read_joints(skin, nodes_.size());
  accessors_.budget().take(numbers.size(), 2 * sizeof(glm::dmat4), skin);
  Joints worlds;
  for (const std::size_t joint : numbers) worlds.push_back(hierarchy_.world(joint, key));
  Joints joints = joint_matrices(skin, worlds, accessors_);
  for (const glm::dmat4 &joint : joints)
    if (!usable(joint)) skin.fail("the transform of one of its joints is not finite or beyond all measure");
  return joints;
}

// One where neither weights nor joints change.
std::vector<MeshPose> Nodes::mesh_poses(std::size_t number, bool skinned) {
  const Value node = nodes_[number];
  std::vector<MeshPose> poses;
  bool deforms = false;
  for (std::size_t key = 0; key < hierarchy_.keys(); key++) {
    poses.push_back({hierarchy_.pose(number, key).weights, skinned ? joints_of(node, key) : std::nullopt});
    deforms = deforms || poses[key].weights != poses[0].weights || poses[key].joints != poses[0].joints;
  }
  if (!deforms) poses.resize(1);
  return poses;
}

void Nodes::add_node(std::size_t number, Scene &scene) {
  const Value node = nodes_[number];
  node.check_extensions({"KHR_lights_punctual", "EXT_mesh_gpu_instancing"});
  const Value mesh = node["mesh"], camera = node["camera"], light = node.extension("KHR_lights_punctual");
  // Extras may be anything at all.
  const Value extras = node["extras"], shape = extras && extras.json().is_object() ? extras["sunstone_shape"] : Value(node.context(), nullptr, "");
  if (!mesh && !camera && !light && !shape) return;
  for (std::size_t key = 0; key < hierarchy_.keys(); key++)
    if (!usable(hierarchy_.world(number, key))) {
      node.warn("its transform is not finite or beyond all measure, so it was left out");
      return;
    }
  if (mesh) add_instances(number, node, scene);
  if (camera) add_camera(number, node, scene);
  if (light) add_light(number, node, scene);
  if (shape) add_shape(number, node, shape, scene);
}

void Nodes::add_instances(std::size_t number, const Value &node, Scene &scene) {
  const Value instancing = node.extension("EXT_mesh_gpu_instancing");
  if (instancing && node["skin"]) instancing.warn("a mesh that is placed many times does not follow its skin");
  std::vector<MeshPose> poses = mesh_poses(number, !instancing);
  const bool skinned = poses[0].joints.has_value();
  const std::size_t keys = hierarchy_.keys(number);
  const int mesh = meshes_.mesh(node, std::move(poses), scene);
  if (mesh < 0) return;
  // `within` the node's own space, where it stands elsewhere than that.
  const auto add = [&](std::string name, const glm::dmat4 *within) {
    const auto at = [&](std::size_t key) { return rounded(within ? hierarchy_.world(number, key) * *within : hierarchy_.world(number, key)); };
    Instance instance{std::move(name), mesh, at(0)};
    for (std::size_t key = 1; key < keys; key++) instance.keys.push_back(at(key));
    scene.instances.push_back(std::move(instance));
  };
  std::string name = node["name"].text();
  if (name.empty()) name = scene.meshes[static_cast<std::size_t>(mesh)].name;
  if (!instancing) {
    // Joints alone say where a skinned mesh is: its node's own place has no part in it.
    if (skinned)
      scene.instances.push_back({std::move(name), mesh, glm::mat4x3(1)});
    else
      add(std::move(name), nullptr);
    return;
  }
  const Value attributes = instancing["attributes"];
  attributes.expect_object();
  std::optional<std::size_t> count;
  const auto open = [&](const char *key, int components) -> std::optional<Accessor> {
    const Value attribute = attributes[key];
    if (!attribute) return {};
    Accessor accessor = accessors_.open(attribute, components);
    if (count && *count != accessor.count)
      attribute.fail("has " + counted(accessor.count, "elements") + ", but another attribute has " + std::to_string(*count));
    count = accessor.count;
    return accessor;
  };
  const std::optional<Accessor> translation = open("TRANSLATION", 3), rotation = open("ROTATION", 4), scale = open("SCALE", 3);
  if (!count) attributes.fail("has none of TRANSLATION, ROTATION, SCALE");
  accessors_.budget().take(*count, sizeof(Instance) + name.size(), node);
  std::vector<glm::vec3> translations, scales;
  std::vector<glm::vec4> rotations;
  if (translation) translations = accessors_.floats<3>(*translation);
  if (rotation) rotations = accessors_.floats<4>(*rotation);
  if (scale) scales = accessors_.floats<3>(*scale);
  for (std::size_t i = 0; i < *count; i++) {
    const glm::dvec3 t = translation ? glm::dvec3(translations[i]) : glm::dvec3(0), s = scale ? glm::dvec3(scales[i]) : glm::dvec3(1);
    const glm::dvec4 q = rotation ? unit_quaternion(glm::dvec4(rotations[i]), attributes["ROTATION"]) : glm::dvec4(0, 0, 0, 1);
    const glm::dmat4 within = compose(t, q, s);
    bool fits = true;
    for (std::size_t key = 0; key < hierarchy_.keys(); key++) fits = fits && usable(hierarchy_.world(number, key) * within);
    if (fits)
      add(name, &within);
    else
      instancing.warn("instances whose transform is not finite or beyond all measure were left out");
  }
}

void Nodes::add_camera(std::size_t number, const Value &node, Scene &scene) {
  const Value value = cameras_[node["camera"].index(cameras_.size(), "cameras")];
  value.expect_object();
  value.check_extensions({});
  Camera camera;
  camera.name = name_of(value, node);
  const std::string type = value["type"].text();
  if (type == "perspective") {
    const Value lens = value["perspective"];
    lens.expect_object();
    const Value yfov = lens["yfov"], aspect = lens["aspectRatio"];
    if (!yfov) yfov.fail("is missing");
    camera.yfov = yfov.real(0);
    if (!(camera.yfov > 0) || !(static_cast<double>(camera.yfov) < pi)) yfov.fail("an angle of view has to lie between 0 and pi");
    if (aspect) {
      camera.aspect = aspect.real(0);
      if (!(*camera.aspect > 0)) aspect.fail("an aspect ratio has to be above 0");
    }
  } else if (type == "orthographic") {
    camera.orthographic = true;
    const Value box = value["orthographic"];
    box.expect_object();
    for (const char *key : {"xmag", "ymag"}) {
      if (!box[key]) box[key].fail("is missing");
      if (!(box[key].real(0) > 0)) box[key].fail("has to be above 0");
    }
    camera.half_width = box["xmag"].real(0);
    camera.half_height = box["ymag"].real(0);
    camera.aspect = camera.half_width / camera.half_height;
  } else {
    value["type"].fail(value["type"] ? "\"" + printable(type) + "\" is neither perspective nor orthographic" : "is missing");
  }
  // Rigid: a camera has no size, so its axes are made unit and perpendicular, the line of sight first.
  const auto rigid = [](const glm::dmat4 &world) -> std::optional<glm::mat4x3> {
    const std::optional<glm::dvec3> back = unit(glm::dvec3(world[2]));
    const std::optional<glm::dvec3> right = back ? unit(glm::cross(glm::dvec3(world[1]), *back)) : std::nullopt;
    if (!right) return {};
    return glm::mat4x3(glm::vec3(*right), glm::vec3(glm::cross(*back, *right)), glm::vec3(*back), glm::vec3(world[3]));
  };
  for (std::size_t key = 0; key < hierarchy_.keys(number); key++) {
    const std::optional<glm::mat4x3> transform = rigid(hierarchy_.world(number, key));
    if (!transform) {
      node.warn("its transform leaves a camera no direction, so the camera was left out");
      return;
    }
    if (key == 0)
      camera.transform = *transform;
    else
      camera.keys.push_back(*transform);
  }
  scene.cameras.push_back(std::move(camera));
}

// An analytic shape: {"shape": index into KHR_implicit_shapes} or {"type": "disk" | "quad" | "plane" ...}; docs/conventions.md has the whole of it.
void Nodes::add_shape(std::size_t number, const Value &node, const Value &value, Scene &scene) {
  value.expect_object();
  Shape shape;
  shape.name = node["name"].text();
  glm::dvec3 size(1);
  // A size has to be there or have a default, and be above 0.
  const auto measure = [](const Value &number, double otherwise) {
    const double size = number.number(otherwise);
    if (!(size > 0) || !std::isfinite(size)) number.fail("a size has to be above 0");
    return size;
  };
  const Value reference = value["shape"], type = value["type"];
  if (reference) {
    if (type) type.fail("stands beside \"shape\"", "a shape is an index into KHR_implicit_shapes, or has a type of sunstone's own");
    const Value implicit = shapes_[reference.index(shapes_.size(), "shapes")];
    implicit.expect_object();
    const Value kind = implicit["type"];
    if (!kind) kind.fail("is missing");
    if (kind.text() != "sphere")
      kind.fail("\"" + printable(kind.text()) + "\" is not rendered: of KHR_implicit_shapes sunstone has the sphere", "use a mesh, or a type of sunstone's own: disk, quad, plane");
    shape.kind = Shape::Kind::sphere;
    size = glm::dvec3(measure(implicit["sphere"]["radius"], 0.5));
  } else if (type.text() == "disk") {
    shape.kind = Shape::Kind::disk;
    size = glm::dvec3(measure(value["radius"], 1));
  } else if (type.text() == "quad") {
    shape.kind = Shape::Kind::quad;
    const Value extent = value["size"];
    if (extent) {
      extent.numbers(2);
      size = {0.5 * measure(extent[0], 0), 1, 0.5 * measure(extent[1], 0)};
    } else {
      size = {0.5, 1, 0.5};
    }
  } else if (type.text() == "plane") {
    shape.kind = Shape::Kind::plane;
  } else {
    type.fail(type ? "\"" + printable(type.text()) + "\" is none of disk, quad, plane" : "is missing", "a sphere is {\"shape\": N}, with N an index into KHR_implicit_shapes");
  }
  if (shape.kind != Shape::Kind::sphere) size.y = size.x;  // its normal's length means nothing; alike, it keeps the transform regular
  shape.material = materials_.material(value["material"], scene);
  accessors_.budget().take(1, sizeof(Shape) + shape.name.size(), node);
  for (std::size_t key = 0; key < hierarchy_.keys(number); key++) {
    const glm::dmat4 transform =
        hierarchy_.world(number, key) * glm::dmat4(glm::dvec4(size.x, 0, 0, 0), glm::dvec4(0, size.y, 0, 0), glm::dvec4(0, 0, size.z, 0), glm::dvec4(0, 0, 0, 1));
    if (!usable(transform)) {
      node.warn("its transform is not finite or beyond all measure, so it was left out");
      return;
    }
    if (key == 0)
      shape.transform = rounded(transform);
    else
      shape.keys.push_back(rounded(transform));
  }
  scene.shapes.push_back(std::move(shape));
}

// KHR_lights_punctual: shines along the node's -z; neither intensity nor angles are scaled by the node.
void Nodes::add_light(std::size_t number, const Value &node, Scene &scene) {
  const Value value = lights_[node.extension("KHR_lights_punctual")["light"].index(lights_.size(), "lights")];
  value.expect_object();
  value.check_extensions({});
  Light light;
  light.name = name_of(value, node);
  const std::string type = value["type"].text();
  if (type == "point")
    light.kind = Light::Kind::point;
  else if (type == "spot")
    light.kind = Light::Kind::spot;
  else if (type == "directional")
    light.kind = Light::Kind::directional;
  else
    value["type"].fail(value["type"] ? "\"" + printable(type) + "\" is none of point, spot, directional" : "is missing");
  light.intensity = value["color"].factors(glm::vec3(1), 0, 1e18f) * value["intensity"].factor(1, 0, 1e18f);
  if (light.kind == Light::Kind::spot) {
    const Value spot = value["spot"];
    spot.expect_object();
    light.outer_angle = spot["outerConeAngle"].factor(0.7853982f, 1e-3f, 1.5707964f);
    light.inner_angle = spot["innerConeAngle"].factor(0, 0, 1.5707964f);
    if (!(light.inner_angle < light.outer_angle)) {
      spot.warn("its inner cone is not within the outer one and was clamped");
      light.inner_angle = light.outer_angle * 0.999f;  // never equal: the fall-off divides by the difference of their cosines
    }
  }
  for (std::size_t key = 0; key < hierarchy_.keys(number); key++) {
    const glm::dmat4 &place = hierarchy_.world(number, key);
    LightKey now{glm::vec3(place[3]), light.direction};
    if (light.kind != Light::Kind::point) {
      const std::optional<glm::dvec3> direction = unit(-glm::dvec3(place[2]));
      if (!direction) {
        node.warn("its transform leaves a light no direction, so the light was left out");
        return;
      }
      now.direction = glm::vec3(*direction);
    }
    if (key > 0) {
      light.keys.push_back(now);
      continue;
    }
    light.position = now.position;
    light.direction = now.direction;
  }
  scene.lights.push_back(std::move(light));
}

}  // namespace sunstone::gltf
