// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_hierarchy.h"

#include <algorithm>
#include <cmath>

#include "shared/motion.h"

namespace sunstone::gltf {

glm::dmat4 compose(const glm::dvec3 &t, const glm::dvec4 &q, const glm::dvec3 &s) {
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  return {glm::dvec4(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0) * s.x,
          glm::dvec4(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0) * s.y,
          glm::dvec4(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0) * s.z, glm::dvec4(t, 1)};
}

glm::dvec4 unit_quaternion(const glm::dvec4 &q, const Value &who) {
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (length > 1e-150 && std::isfinite(length)) return q / length;
  who.warn("a rotation of length zero was taken as none");
  return {0, 0, 0, 1};
}

static glm::dmat4 local_transform(const Value &node, const Pose &pose) {
  if (const Value matrix = node["matrix"]) {
    const std::vector<double> m = matrix.numbers(16);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) matrix.warn("its last row is not 0 0 0 1 and was taken as that");
    return {m[0], m[1], m[2], 0, m[4], m[5], m[6], 0, m[8], m[9], m[10], 0, m[12], m[13], m[14], 1};
  }
  glm::dvec3 t(0), s(1);
  glm::dvec4 q(0, 0, 0, 1);
  if (const Value value = node["translation"]) {
    const std::vector<double> v = value.numbers(3);
    t = {v[0], v[1], v[2]};
  }
  if (const Value value = node["rotation"]) {
    const std::vector<double> v = value.numbers(4);
    q = unit_quaternion({v[0], v[1], v[2], v[3]}, value);
  }
  if (const Value value = node["scale"]) {
    const std::vector<double> v = value.numbers(3);
    s = {v[0], v[1], v[2]};
  }
  return compose(pose.translation.value_or(t), pose.rotation.value_or(q), pose.scale.value_or(s));
}

Hierarchy::Hierarchy(const Value &root) : root_(root), nodes_(root["nodes"]) {}

// Strict trees: no node has two parents, and none is its own ancestor.
void Hierarchy::check() {
  const std::size_t count = nodes_.size();
  parents_.assign(count, -1);
  children_.resize(count);
  for (std::size_t i = 0; i < count; i++) {
    const Value node = nodes_[i];
    node.expect_object();
    const Value children = node["children"];
    children_[i].reserve(children.size());
    for (std::size_t k = 0; k < children.size(); k++) {
      const std::size_t child = children[k].index(count, "nodes");
      if (parents_[child] >= 0)
        nodes_[child].fail("is a child of nodes[" + std::to_string(parents_[child]) + "] and of nodes[" + std::to_string(i) + "]",
                           "nodes have to form trees");
      parents_[child] = static_cast<int>(i);
      children_[i].push_back(static_cast<std::uint32_t>(child));
    }
  }
  // With one parent each, whatever no root leads to lies on or below a cycle.
  std::vector<bool> reached(count, false);
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < count; i++)
    if (parents_[i] < 0) stack.push_back(i);
  while (!stack.empty()) {
    const std::size_t i = stack.back();
    stack.pop_back();
    reached[i] = true;
    stack.insert(stack.end(), children_[i].begin(), children_[i].end());
  }
  for (std::size_t i = 0; i < count; i++) {
    if (reached[i]) continue;
    std::size_t on_cycle = i;
    for (std::size_t step = 0; step < count; step++) on_cycle = static_cast<std::size_t>(parents_[on_cycle]);
    nodes_[on_cycle].fail("is its own ancestor");
  }
}

std::vector<std::size_t> Hierarchy::scene_roots() const {
  std::vector<std::size_t> roots;
  const Value scenes = root_["scenes"], chosen = root_["scene"];
  Context &context = root_.context();
  if (scenes.size() == 0 && !chosen) {
    context.notices.note(context.file, "it has no scene, so all of its nodes are shown");
    for (std::size_t i = 0; i < parents_.size(); i++)
      if (parents_[i] < 0) roots.push_back(i);
    return roots;
  }
  if (!chosen && scenes.size() > 1) context.notices.note(context.file, "the first of its " + std::to_string(scenes.size()) + " scenes is shown");
  const Value scene = scenes[chosen ? chosen.index(scenes.size(), "scenes") : 0];
  scene.expect_object();
  scene.check_extensions({});
  const Value listed = scene["nodes"];
  std::vector<bool> seen(parents_.size(), false);
  for (std::size_t i = 0; i < listed.size(); i++) {
    const std::size_t node = listed[i].index(parents_.size(), "nodes");
    if (parents_[node] >= 0)
      listed[i].fail("nodes[" + std::to_string(node) + "] is no root: it is a child of nodes[" + std::to_string(parents_[node]) + "]");
    if (seen[node]) listed[i].fail("nodes[" + std::to_string(node) + "] stands there twice");
    seen[node] = true;
    roots.push_back(node);
  }
  return roots;
}

// World transforms of all below these roots. Depth first, in the file's order: each list is pushed from its end.
void Hierarchy::place_below(const std::vector<std::size_t> &roots) {
  struct Visit {
    std::size_t node;
    glm::dmat4 parent;
  };
  std::vector<Visit> stack;
  for (std::size_t i = roots.size(); i-- > 0;) stack.push_back({roots[i], glm::dmat4(1)});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const glm::dmat4 world = visit.parent * local_transform(nodes_[visit.node], poses_[visit.node]);
    worlds_[visit.node] = world;
    order_.push_back(visit.node);
    const std::vector<std::uint32_t> &children = children_[visit.node];
    for (std::size_t i = children.size(); i-- > 0;) stack.push_back({children[i], world});
  }
}

Hierarchy::Key Hierarchy::key_at(const Animation &animation, double time) const {
  Key key;
  for (const std::size_t node : moving_) {
    key.poses.push_back(animation.pose(node, time));
    const int parent = parents_[node], among = parent < 0 ? -1 : place_in_moving_[static_cast<std::size_t>(parent)];
    const glm::dmat4 above = parent < 0 ? glm::dmat4(1) : among < 0 ? worlds_[static_cast<std::size_t>(parent)] : key.worlds[static_cast<std::size_t>(among)];
    key.worlds.push_back(above * local_transform(nodes_[node], key.poses.back()));
  }
  return key;
}

void Hierarchy::find_moving(const Animation &animation) {
  place_in_moving_.assign(nodes_.size(), -1);
  for (const std::size_t node : order_) {
    const int parent = parents_[node];
    if (!animation.moves(node) && (parent < 0 || place_in_moving_[static_cast<std::size_t>(parent)] < 0)) continue;
    place_in_moving_[node] = static_cast<int>(moving_.size());
    moving_.push_back(node);
  }
}

// Is a straight line between each two keys near enough to the way? By a thousandth: of a node's size where it turns or grows, of its way where its origin goes,
// of the range of a weight. Looked at in three places a step, which no regular motion favours.
bool Hierarchy::straight(const std::vector<Key> &keys, const Animation &animation, double time, double shutter) const {
  constexpr double bound = 1.0 / 1024, places[] = {0.29, 0.5, 0.83};
  const auto size = [](const glm::dvec3 &v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); };
  const std::size_t steps = keys.size() - 1;
  std::vector<double> way(moving_.size());
  for (const Key &key : keys)
    for (std::size_t i = 0; i < moving_.size(); i++) way[i] = std::max(way[i], size(glm::dvec3(key.worlds[i][3] - keys[0].worlds[i][3])));
  for (std::size_t step = 0; step < steps; step++)
    for (const double place : places) {
      const Key real = key_at(animation, time + shutter * ((static_cast<double>(step) + place) / static_cast<double>(steps)));
      for (std::size_t i = 0; i < moving_.size(); i++) {
        const glm::dmat4 &a = keys[step].worlds[i], &b = keys[step + 1].worlds[i], &m = real.worlds[i];
        const auto error = [&](int column) { return size(glm::dvec3(a[column] + (b[column] - a[column]) * place - m[column])); };
        const double extent = std::max({size(glm::dvec3(m[0])), size(glm::dvec3(m[1])), size(glm::dvec3(m[2]))});
        for (int column = 0; column < 3; column++)
          if (error(column) > bound * extent) return false;
        if (error(3) > bound * std::max(way[i], size(glm::dvec3(m[3] - keys[0].worlds[i][3])))) return false;
        if (!real.poses[i].weights) continue;
        const std::vector<double> &w = *real.poses[i].weights, &wa = *keys[step].poses[i].weights, &wb = *keys[step + 1].poses[i].weights, &first = *keys[0].poses[i].weights;
        for (std::size_t k = 0; k < w.size(); k++) {
          double range = std::fabs(w[k] - first[k]);
          for (const Key &key : keys) range = std::max(range, std::fabs((*key.poses[i].weights)[k] - first[k]));
          if (std::fabs(wa[k] + (wb[k] - wa[k]) * place - w[k]) > bound * range) return false;
        }
      }
    }
  return true;
}

// Twice as many until lines are straight enough. None where the file, or all that it shows, keeps still.
void Hierarchy::make_keys(const Animation &animation, double time, double shutter) {
  find_moving(animation);
  if (moving_.empty() || !(shutter > 0)) return;
  std::vector<Key> keys;
  for (unsigned steps = 1;; steps *= 2) {
    std::vector<Key> finer;
    for (unsigned k = 0; k <= steps; k++)
      finer.push_back(k % 2 == 0 && !keys.empty() ? std::move(keys[k / 2]) : key_at(animation, time + shutter * (static_cast<double>(k) / steps)));
    keys = std::move(finer);
    if (steps == SUN_MOST_MOTION_STEPS || straight(keys, animation, time, shutter)) break;
  }
  const auto same = [&](const Key &key) {
    for (std::size_t i = 0; i < moving_.size(); i++)
      if (key.worlds[i] != keys[0].worlds[i] || key.poses[i].weights != keys[0].poses[i].weights) return false;
    return true;
  };
  if (!std::all_of(keys.begin(), keys.end(), same)) keys_ = std::move(keys);
}

const glm::dmat4 &Hierarchy::world(std::size_t node, std::size_t key) const {
  return key == 0 || place_in_moving_[node] < 0 ? worlds_[node] : keys_[key].worlds[static_cast<std::size_t>(place_in_moving_[node])];
}

const Pose &Hierarchy::pose(std::size_t node, std::size_t key) const {
  return key == 0 || place_in_moving_[node] < 0 ? poses_[node] : keys_[key].poses[static_cast<std::size_t>(place_in_moving_[node])];
}

std::size_t Hierarchy::keys(std::size_t node) const {
  for (std::size_t key = 1; key < keys_.size(); key++)
    if (world(node, key) != worlds_[node]) return keys_.size();
  return 1;
}

std::vector<std::size_t> Hierarchy::place(const Animation &animation, double time, double shutter) {
  check();
  const std::size_t count = nodes_.size();
  for (std::size_t i = 0; i < count; i++) poses_.push_back(animation.pose(i, time));
  worlds_.assign(count, glm::dmat4(1));
  const std::vector<std::size_t> roots = scene_roots();
  place_below(roots);
  const std::vector<std::size_t> shown = order_;
  if (root_["skins"]) {
    // Joints may stand outside the scene.
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < count; i++)
      if (parents_[i] < 0 && std::find(roots.begin(), roots.end(), i) == roots.end()) others.push_back(i);
    place_below(others);
  }
  make_keys(animation, time, shutter);
  return shown;
}

}  // namespace sunstone::gltf
