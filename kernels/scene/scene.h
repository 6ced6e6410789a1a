// SPDX-License-Identifier: Apache-2.0
// The flattened scene as kernels see it: its buffers, bundled at the door of a kernel.
#ifndef SUN_SCENE_SCENE_H
#define SUN_SCENE_SCENE_H
#include "math/record.h"
#include "scene/moment.h"
#include "scene/texture.h"
#include "shared/emitter.h"
#include "shared/frame.h"
#include "shared/geometry.h"
#include "shared/material.h"
#include "shared/tables.h"
#include "shared/texture.h"

SUN_NAMESPACE_BEGIN

typedef struct Scene {
  const SUN_GLOBAL Frame *frame;
  const SUN_GLOBAL Vertex *vertices;
  const SUN_GLOBAL VertexExtra *extras;
  const SUN_GLOBAL Triangle *triangles;
  const SUN_GLOBAL Instance *instances;
  const SUN_GLOBAL Motion *motion;
  Moment moment;  // all questions are asked of the scene as it is then: see at_moment
  const SUN_GLOBAL uint *triangle_emitter;
  const SUN_GLOBAL uint *triangle_object, *instance_object;
  const SUN_GLOBAL Material *materials;
  const SUN_GLOBAL TextureRef *texture_refs;
  const SUN_GLOBAL Texture *textures;
  const SUN_GLOBAL Emitter *emitters;
  const SUN_GLOBAL Light *lights;
  const SUN_GLOBAL float *tables;
  const SUN_GLOBAL float *environment_texels;
  const SUN_GLOBAL float *environment_cdf;
  TexturePages pages;
  int alike;  // all lanes ask for records of one instance, one material: they are read once (LANES_ALIKE)
} Scene;

// The buffers of a scene, as every kernel that shades takes them.
#define SCENE_PARAMETERS                                                                                                                  \
  const SUN_GLOBAL Vertex *vertices, const SUN_GLOBAL VertexExtra *extras, const SUN_GLOBAL Triangle *triangles,                          \
      const SUN_GLOBAL Instance *instances, const SUN_GLOBAL uint *records, const SUN_GLOBAL uint *page0, const SUN_GLOBAL uint *page1, \
      const SUN_GLOBAL uint *page2, const SUN_GLOBAL uint *page3
#define SCENE_ARGUMENTS vertices, extras, triangles, instances, records, page0, page1, page2, page3

// `records` is one buffer of all small tables; the frame says where each begins.
SUN_FN Scene open_scene(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS) {
  Scene scene;
  scene.frame = frame;
  scene.vertices = vertices;
  scene.extras = extras;
  scene.triangles = triangles;
  scene.instances = instances;
  scene.motion = (const SUN_GLOBAL Motion *)(instances + frame->instance_count + frame->plane_count);
  scene.moment = still_moment();
  scene.triangle_emitter = records + frame->at_triangle_emitter;
  scene.triangle_object = records + frame->at_triangle_object;
  scene.instance_object = records + frame->at_instance_object;
  scene.materials = (const SUN_GLOBAL Material *)(records + frame->at_materials);
  scene.texture_refs = (const SUN_GLOBAL TextureRef *)(records + frame->at_texture_refs);
  scene.textures = (const SUN_GLOBAL Texture *)(records + frame->at_textures);
  scene.emitters = (const SUN_GLOBAL Emitter *)(records + frame->at_emitters);
  scene.lights = (const SUN_GLOBAL Light *)(records + frame->at_lights);
  scene.tables = (const SUN_GLOBAL float *)(records + frame->at_tables);
  scene.environment_texels = (const SUN_GLOBAL float *)(records + frame->at_environment_texels);
  scene.environment_cdf = (const SUN_GLOBAL float *)(records + frame->at_environment_cdf);
  scene.pages.page[0] = page0;
  scene.pages.page[1] = page1;
  scene.pages.page[2] = page2;
  scene.pages.page[3] = page3;
  scene.alike = 0;
  return scene;
}

// The scene at the time of LANES samples.
SUN_FN void at_moment(Scene *scene, const SamplerKey *key) {
  if (SUN_MOTION) scene->moment = sample_moment(scene->frame, key);
}

// A field of LANES records: GATHER_FLOAT(roughness, scene->materials, index, roughness).
#define GATHER_FLOAT(out, records, index, field)                                    \
  do {                                                                              \
    uint gather_at[LANES];                                                          \
    float gather_value[LANES];                                                      \
    LANES_STORE(index, gather_at);                                                  \
    for (int lane = 0; lane < LANES; lane++) gather_value[lane] = LANE_WORD(float, (records)[gather_at[lane]].field); \
    (out) = LANES_LOAD(gather_value);                                               \
  } while (0)
#define GATHER_UINT(out, records, index, field)                                     \
  do {                                                                              \
    uint gather_at[LANES], gather_value[LANES];                                     \
    LANES_STORE(index, gather_at);                                                  \
    for (int lane = 0; lane < LANES; lane++) gather_value[lane] = LANE_WORD(uint, (records)[gather_at[lane]].field); \
    (out) = LANES_LOAD(gather_value);                                               \
  } while (0)
// Three floats at a multiple of 16 bytes.
#define GATHER_VEC3(out, records, index, field)                                                         \
  do {                                                                                                  \
    Quad vec3_quad;                                                                                     \
    GATHER_QUAD(vec3_quad, records, index, field);                                                      \
    (out) = make_vec3(real_of_bits(vec3_quad.x), real_of_bits(vec3_quad.y), real_of_bits(vec3_quad.z)); \
  } while (0)

// A field of the scene's records: SCENE_FLOAT(roughness, scene, materials, index, roughness). Where kernels sort their lanes by shape, those of one shape name
// the same record, which is read once; `alike` of other kernels is 0 when they are compiled.
#define LANES_ALIKE(scene) (SUN_FEW_SHAPES && (scene)->alike)
#define SCENE_FLOAT(out, scene, records, index, field)             \
  do {                                                             \
    if (LANES_ALIKE(scene))                                        \
      (out) = (real)((scene)->records[FIRST_LANE(index)].field);   \
    else                                                           \
      GATHER_FLOAT(out, (scene)->records, index, field);           \
  } while (0)
#define SCENE_UINT(out, scene, records, index, field)              \
  do {                                                             \
    if (LANES_ALIKE(scene))                                        \
      (out) = (uint_n)((scene)->records[FIRST_LANE(index)].field); \
    else                                                           \
      GATHER_UINT(out, (scene)->records, index, field);            \
  } while (0)
#define SCENE_QUAD(out, scene, records, index, field) RECORD_QUAD(out, LANES_ALIKE(scene), FIRST_LANE(index), (scene)->records, index, field)
#define SCENE_VEC3(out, scene, records, index, field)                                                           \
  do {                                                                                                          \
    Quad scene_quad;                                                                                            \
    SCENE_QUAD(scene_quad, scene, records, index, field);                                                       \
    (out) = make_vec3(real_of_bits(scene_quad.x), real_of_bits(scene_quad.y), real_of_bits(scene_quad.z));      \
  } while (0)

SUN_NAMESPACE_END
#endif
