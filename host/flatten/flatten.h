// SPDX-License-Identifier: Apache-2.0
// Scene -> FlatScene: vectors of the structs in kernels/shared, in upload order. Everything but the tree is scene data and enters scene_hash.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "base/hash.h"
#include "base/notice.h"
#include "scene/scene.h"
#include "shared/bvh.h"
#include "shared/emitter.h"
#include "shared/frame.h"
#include "shared/geometry.h"
#include "shared/material.h"
#include "shared/motion.h"
#include "shared/tables.h"
#include "shared/texture.h"

namespace sunstone {

enum class Layout { binary, wide8, wide16 };
const char *layout_name(Layout layout);
Layout layout_from_name(const std::string &name);  // UsageError with the names there are

// What a layout's traversal reads. Bytes of BinaryNode and LeafTriangle, or of Wide8Node / Wide16Node and WidePack.
struct Tree {
  Layout layout = Layout::binary;
  std::vector<std::byte> nodes;
  std::vector<std::byte> leaves;
  std::vector<kernel::uint> instance_list;  // binary: the top tree's leaves index this; wide: empty
  std::vector<kernel::uint> roots;          // of each instance's mesh, by instance number: a node, or (wide) a leaf with SUN_WIDE_LEAF; of a shape: its primitive
  kernel::uint top_root = 0;                // not used where there is one instance
  std::size_t node_count = 0, leaf_count = 0, depth = 0;
};

// The triangles of one mesh, or the one that stands for a shape: a range of FlatScene::triangles. Those that are split have their pieces, in the order of the triangles, in a range of
// FlatScene::fragments.
struct MeshRange {
  kernel::uint first_triangle = 0, triangle_count = 0;
  kernel::uint first_fragment = 0, fragment_count = 0;
  bool deforms = false;  // its vertices have keys
};

struct FlatScene {
  std::vector<kernel::Vertex> vertices;
  std::vector<kernel::VertexExtra> vertex_extras;   // as many as vertices, or exactly one
  std::vector<kernel::Triangle> triangles;
  std::vector<kernel::uint> triangle_ids;           // primitive number and SUN_ID_ bits, by triangle
  std::vector<kernel::uint> triangle_emitter;       // number among its mesh's emissive triangles, or SUN_NONE
  std::vector<kernel::uint> triangle_object;        // of a baked mesh: the number of the scene's instance, from 1; else 0
  std::vector<kernel::Fragment> fragments;          // pieces of long triangles, and one at either end
  std::vector<MeshRange> meshes;
  std::vector<kernel::uint> instance_mesh;          // into meshes, by instance
  std::vector<kernel::uint> instance_object;        // the number of the scene's instance, from 1; 0 for the one that holds the baked meshes
  std::vector<kernel::Instance> instances;          // of meshes, of shapes with bounds, of infinite planes, in this order
  std::size_t shape_count = 0, plane_count = 0;     // shapes among them, planes among these
  unsigned motion_steps = 0;                        // keys less one (shared/motion.h); 0: all is still
  kernel::uint deforming = 0;                       // vertices that have keys: those of each key stand so far behind those of the one before
  std::vector<kernel::InstanceKey> instance_keys;   // motion_steps + 1 of each instance that moves
  std::vector<kernel::Material> materials;
  std::vector<kernel::TextureRef> texture_refs;
  std::vector<kernel::Texture> textures;
  std::array<std::vector<kernel::uint>, SUN_TEXTURE_PAGES> texel_pages;
  std::vector<kernel::Emitter> emitters;
  std::vector<kernel::Light> lights;
  std::vector<kernel::Light> light_keys;            // motion_steps + 1 of each light that moves; they stand behind the lights
  std::vector<kernel::Camera> camera_keys;          // of the picture's camera, where that moves: no part of the scene, flatten leaves it empty
  kernel::Environment environment{};
  std::vector<float> environment_texels;            // RGB, rows from the top; strength multiplied in
  std::vector<float> environment_cdf;               // (height + 1) marginal, then height rows of (width + 1)
  std::vector<float> tables;                        // SUN_TABLE_FLOATS; the filter's part is filled by the pipeline
  Bounds bounds;                                    // of all but infinite planes
  Tree tree;
  Hash scene_hash;
  // Does anything move (or only the camera, or nothing), or do vertices deform? The switch SUN_MOTION.
  int motion() const { return motion_steps == 0 ? 0 : deforming ? 2 : 1; }
  bool has_passable = false, has_textures = false, has_specular = false;  // textures, or colours of vertices
};

struct FlattenOptions {
  Layout layout = Layout::wide16;
  std::size_t max_page_bytes = std::size_t(1) << 31;  // of one buffer on the device
  std::function<void(const char *what, double fraction)> progress;
};

// Bytes that flatten will take and the device buffers will hold: printed before anything is allocated.
struct MemoryEstimate {
  std::size_t geometry = 0, tree = 0, textures = 0, other = 0;
  std::size_t total() const { return geometry + tree + textures + other; }
};
MemoryEstimate estimate_memory(const Scene &scene, Layout layout);

// Throws Error where the scene has too many triangles, emitters or texels for one device.
FlatScene flatten(const Scene &scene, const FlattenOptions &options, Notices &notices);

// The instances and, where something moves, their keys behind them: what the kernels' buffer of instances holds.
std::vector<kernel::Instance> instances_with_keys(const FlatScene &scene);

// The tree alone, over flattened geometry: in flatten/bvh.h. Camera and film constants of a picture: in flatten/camera.h.

}  // namespace sunstone
