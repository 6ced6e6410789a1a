// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_animations.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number.h"

namespace sunstone::gltf {

namespace {

Value chosen(const Value &animations, const std::string &choice) {
  if (choice.empty()) return animations[0];
  const std::optional<std::size_t> number = read_number<std::size_t>(choice);
  std::optional<std::size_t> found;
  std::string known;
  for (std::size_t i = 0; i < animations.size(); i++) {
    animations[i].expect_object();
    const std::string name = animations[i]["name"].text();
    if (i < 20) known += (i ? ", " : "") + std::to_string(i) + " \"" + printable(name) + "\"";
    if (!found && (name == choice || number == i)) found = i;
  }
  if (!found) throw UsageError("--animation " + printable(choice), "no such animation; there are " + known + (animations.size() > 20 ? ", ..." : ""));
  return animations[*found];
}

// Of a channel's node, which its weights belong to: targets of its mesh's first primitive. The others are held against it as they are read.
std::size_t target_count(const Value &node, const Value &root) {
  const Value reference = node["mesh"];
  if (!reference) node.fail("its morph weights are animated, but it has no mesh");
  const Value mesh = root["meshes"][reference.index(root["meshes"].size(), "meshes")];
  mesh.expect_object();
  const Value primitives = mesh["primitives"];
  const std::size_t targets = primitives.size() ? primitives[0]["targets"].size() : 0;
  if (targets == 0) mesh.fail("its morph weights are animated, but it has no targets");
  return targets;
}

void expect_finite(const Value &who, const std::vector<double> &values) {
  for (std::size_t i = 0; i < values.size(); i++)
    if (!std::isfinite(values[i])) who.fail("number " + std::to_string(i) + " of its data is not finite");
}

std::vector<double> read_times(const Value &input, Accessors &accessors) {
  const Accessor accessor = accessors.open(input, 1);
  if (accessor.component_type != 5126) accessor.value["componentType"].fail(std::to_string(accessor.component_type) + " cannot be a time: that takes 5126");
  if (accessor.count == 0) input.fail("has no key frame");
  std::vector<double> times = accessors.numbers(accessor);
  expect_finite(accessor.value, times);
  for (std::size_t i = 1; i < times.size(); i++)
    if (!(times[i] > times[i - 1])) accessor.value.fail("times have to ascend, but number " + std::to_string(i) + " does not");
  return times;
}

}  // namespace

Animation::Animation(const Value &root, Accessors &accessors, const std::string &choice) {
  const Value animation = chosen(root["animations"], choice);
  animation.expect_object();
  animation.check_extensions({});
  const Value channels = animation["channels"], samplers = animation["samplers"];
  if (channels.size() == 0) channels.fail(channels ? "is empty" : "is missing");
  for (std::size_t i = 0; i < channels.size(); i++) read_channel(channels[i], samplers, root, accessors);
  bool any = false;
  for (const auto &[node, paths] : curves_)
    for (const auto &[path, curve] : paths) {
      first_ = any ? std::min(first_, curve.times.front()) : curve.times.front();
      last_ = any ? std::max(last_, curve.times.back()) : curve.times.back();
      any = true;
    }
}

void Animation::read_channel(const Value &channel, const Value &samplers, const Value &root, Accessors &accessors) {
  channel.expect_object();
  channel.check_extensions({});
  const Value sampler = samplers[channel["sampler"].index(samplers.size(), "samplers")], target = channel["target"];
  sampler.expect_object();
  sampler.check_extensions({});
  target.expect_object();
  target.check_extensions({});
  const std::string name = target["path"].text();
  if (name == "pointer" || !target["node"]) {  // of an extension, as those say of which no part is supported
    channel.warn("what it animates is no node, and keeps still");
    return;
  }
  const Value node = root["nodes"][target["node"].index(root["nodes"].size(), "nodes")];
  const std::size_t number = target["node"].index(root["nodes"].size(), "nodes");
  node.expect_object();
  const std::map<std::string, Path> paths = {
      {"translation", Path::translation}, {"rotation", Path::rotation}, {"scale", Path::scale}, {"weights", Path::weights}};
  const auto path = paths.find(name);
  if (path == paths.end()) target["path"].fail(target["path"] ? "\"" + printable(name) + "\" is none of translation, rotation, scale, weights" : "is missing");
  if (node["matrix"] && path->second != Path::weights) node["matrix"].fail("a node that is animated has translation, rotation and scale instead");

  Curve curve;
  curve.rotation = path->second == Path::rotation;
  const std::string way = sampler["interpolation"].text("LINEAR");
  if (way == "STEP")
    curve.way = Curve::Way::step;
  else if (way == "CUBICSPLINE")
    curve.way = Curve::Way::cubic;
  else if (way != "LINEAR")
    sampler["interpolation"].fail("\"" + printable(way) + "\" is none of LINEAR, STEP, CUBICSPLINE");
  curve.times = read_times(sampler["input"], accessors);

  const bool weights = path->second == Path::weights;
  const std::size_t an_element = weights ? 1 : curve.rotation ? 4 : 3, elements = weights ? target_count(node, root) : 1;
  curve.components = an_element * elements;
  const Accessor output = accessors.open(sampler["output"], static_cast<int>(an_element));
  const bool integers = (weights || curve.rotation) && output.normalized && output.component_type != 5125;
  if (output.component_type != 5126 && !integers)
    output.value["componentType"].fail(std::to_string(output.component_type) + (output.normalized ? "" : ", not normalised,") + " cannot be a " + name);
  const std::size_t a_key = elements * (curve.way == Curve::Way::cubic ? 3 : 1);
  if (output.count % a_key != 0 || output.count / a_key != curve.times.size())
    sampler["output"].fail("has " + counted(output.count, "elements") + ", but there are " + counted(curve.times.size(), "key frames") + " of " +
                           std::to_string(a_key) + " each");
  curve.values = accessors.numbers(output);
  expect_finite(output.value, curve.values);
  if (!curves_[number].emplace(path->second, std::move(curve)).second)
    target.fail("the " + name + " of nodes[" + std::to_string(number) + "] is animated twice");
}

Pose Animation::pose(std::size_t node, double time) const {
  Pose pose;
  const auto found = curves_.find(node);
  if (found == curves_.end()) return pose;
  for (const auto &[path, curve] : found->second) {
    std::vector<double> v = value_at(curve, time);
    switch (path) {
      case Path::translation:
        pose.translation = {v[0], v[1], v[2]};
        break;
      case Path::rotation:
        pose.rotation = {v[0], v[1], v[2], v[3]};
        break;
      case Path::scale:
        pose.scale = {v[0], v[1], v[2]};
        break;
      case Path::weights:
        // Splines may swing beyond what a float holds.
        for (double &w : v) w = std::clamp(w, -1e30, 1e30);
        pose.weights = std::move(v);
        break;
    }
  }
  return pose;
}

}  // namespace sunstone::gltf
