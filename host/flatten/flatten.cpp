// SPDX-License-Identifier: Apache-2.0
#include "flatten/flatten.h"

#include "base/error.h"
#include "flatten/bvh.h"
#include "flatten/emitters.h"
#include "flatten/fragments.h"
#include "flatten/geometry.h"
#include "flatten/materials.h"
#include "flatten/tables.h"
#include "flatten/textures.h"

namespace sunstone {
namespace {

// Everything but the tree and the tables, field by field; where a texture lies in the pages depends on the device and is left out, what it holds is
// not.
Hash hash_of(const FlatScene &flat) {
  Hasher hasher;
  const auto add = [&](const auto &values) { hasher.span(std::span(values.data(), values.size())); };
  add(flat.vertices);
  add(flat.vertex_extras);
  add(flat.triangles);
  add(flat.triangle_ids);
  add(flat.triangle_emitter);
  add(flat.triangle_object);
  add(flat.fragments);
  for (const MeshRange &mesh : flat.meshes) {
    hasher.value(mesh.first_triangle);
    hasher.value(mesh.triangle_count);
  }
  add(flat.instance_mesh);
  add(flat.instance_object);
  add(flat.instances);
  add(flat.materials);
  add(flat.texture_refs);
  std::map<std::pair<kernel::uint, kernel::uint>, kernel::uint> earlier;  // (page, offset) -> the first texture there
  for (kernel::uint i = 0; i < flat.textures.size(); i++) {
    kernel::Texture texture = flat.textures[i];
    const auto [found, added] = earlier.try_emplace({texture.page, texture.offset}, i);
    const std::size_t words = std::size_t(texture.width) * texture.height *
                              (texture.format == SUN_TEXEL_RGBA32F   ? 4
                               : texture.format == SUN_TEXEL_RGBA16F ? 2
                                                                     : 1);
    if (added) hasher.span(std::span(flat.texel_pages[texture.page]).subspan(texture.offset, words));
    hasher.value(found->second);
    texture.page = texture.offset = 0;
    hasher.bytes(&texture, sizeof texture);
  }
  add(flat.emitters);
  add(flat.lights);
  hasher.bytes(&flat.environment, sizeof flat.environment);
  add(flat.environment_texels);
  add(flat.environment_cdf);
  if (flat.motion_steps) {
    hasher.value(flat.motion_steps);
    hasher.value(flat.deforming);
    add(flat.instance_keys);
    add(flat.light_keys);
  }
  for (int c = 0; c < 3; c++) {
    hasher.value(flat.bounds.lower[c]);
    hasher.value(flat.bounds.upper[c]);
  }
  return hasher.digest();
}

}  // namespace

MemoryEstimate estimate_memory(const Scene &scene, Layout layout) {
  MemoryEstimate estimate;
  const std::vector<MeshUse> uses = mesh_uses(scene);
  const std::size_t keys = scene.motion_steps + 1;
  std::size_t triangles = 0, vertices = 0, instances = 1, moving = 0, leaf_triangles = 0;
  bool extras = false;
  for (std::size_t m = 0; m < uses.size(); m++) {
    if (!uses[m].instances) continue;
    const std::size_t copies = uses[m].baked ? uses[m].instances : 1;
    if (!uses[m].baked) instances += uses[m].instances;
    const std::size_t keys_here = scene.meshes[m].deforms() ? keys : 1;
    for (const Primitive &primitive : scene.meshes[m].primitives) {
      const bool made = needs_tangents(scene, primitive);
      extras = extras || made || !primitive.colors.empty() || !primitive.uv[1].empty();
      triangles += copies * (primitive.indices.size() / 3);
      leaf_triangles += copies * (primitive.indices.size() / 3) * keys_here;
      // Corners part where normals are flat or tangents are made; else there are no more vertices than the primitive has.
      const bool parts = primitive.normals.empty() || (made && primitive.tangents.empty());
      vertices += copies * keys_here * (parts ? primitive.indices.size() : std::min(primitive.positions.size(), primitive.indices.size()));
    }
  }
  estimate.geometry = vertices * (sizeof(kernel::Vertex) + (extras ? sizeof(kernel::VertexExtra) : 0)) +
                      triangles * (sizeof(kernel::Triangle) + 3 * sizeof(kernel::uint)) + triangles / 2 * sizeof(kernel::Fragment) +
                      instances * (sizeof(kernel::Instance) + 3 * sizeof(kernel::uint));
  estimate.geometry += scene.shapes.size() * (sizeof(kernel::Triangle) + sizeof(kernel::Vertex) + sizeof(kernel::Instance) + 6 * sizeof(kernel::uint));
  for (const Instance &instance : scene.instances) moving += !instance.keys.empty();
  for (const Shape &shape : scene.shapes) moving += !shape.keys.empty();
  estimate.geometry += moving * keys * sizeof(kernel::InstanceKey);
  // Leaves are about half full; a node of W children leads to about W / 2 others.
  const std::size_t items = triangles + triangles / 3 + instances;  // pieces of long triangles with them
  const std::size_t more = leaf_triangles - triangles;              // leaves of what deforms stand there once for each key
  switch (layout) {
    case Layout::binary:
      estimate.tree = (items + more) * sizeof(kernel::LeafTriangle) + items * sizeof(kernel::BinaryNode);
      break;
    case Layout::wide8:
      estimate.tree = items / 4 * (sizeof(kernel::WidePack) + sizeof(kernel::Wide8Node) / 4) + more / 4 * sizeof(kernel::WidePack);
      break;
    case Layout::wide16:
      estimate.tree = items / 4 * (sizeof(kernel::WidePack) + sizeof(kernel::Wide16Node) / 8) + more / 4 * sizeof(kernel::WidePack);
      break;
  }
  estimate.textures = texel_bytes(scene);
  estimate.other = SUN_TABLE_FLOATS * sizeof(float) + scene.lights.size() * (sizeof(kernel::Light) + sizeof(kernel::Emitter)) +
                   (scene.materials.size() + 1) * sizeof(kernel::Material);
  if (scene.environment.map) {
    const auto texels = static_cast<std::size_t>(scene.environment.map->width) * static_cast<std::size_t>(scene.environment.map->height);
    estimate.other +=
        (texels * 4 + 2 * static_cast<std::size_t>(scene.environment.map->height) + 1) * sizeof(float);  // radiance and its distribution
  }
  for (const Mesh &mesh : scene.meshes)
    for (const Primitive &primitive : mesh.primitives) {
      const bool emits = primitive.material >= 0 && (scene.materials[static_cast<std::size_t>(primitive.material)].emission != glm::vec3(0) ||
                                                     scene.materials[static_cast<std::size_t>(primitive.material)].unlit);
      if (emits)
        estimate.other +=
            primitive.indices.size() / 3 * uses[static_cast<std::size_t>(&mesh - scene.meshes.data())].instances * sizeof(kernel::Emitter);
    }
  return estimate;
}

FlatScene flatten(const Scene &scene, const FlattenOptions &options, Notices &notices) {
  const auto report = [&](const char *what, double fraction) {
    if (options.progress) options.progress(what, fraction);
  };
  FlatScene flat;
  flat.motion_steps = scene.motion_steps;
  flat.tables = make_tables();

  report("textures", 0);
  TextureLibrary library(scene);
  flatten_materials(scene, library, flat);
  flatten_textures(scene, library, options.max_page_bytes, flat, notices);
  finish_materials(scene, flat);
  report("textures", 1);

  report("geometry", 0);
  flatten_geometry(scene, options.max_page_bytes, flat, notices);
  report("geometry", 1);

  report("emitters", 0);
  flatten_emitters(scene, options.max_page_bytes, flat, notices);
  report("emitters", 1);

  split_long_triangles(flat);
  flat.scene_hash = hash_of(flat);
  flat.tree = build_tree(flat, options.layout, options.progress);
  return flat;
}

}  // namespace sunstone
