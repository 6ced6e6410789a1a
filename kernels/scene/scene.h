// SPDX-License-Identifier: Apache-2.0
// The flattened scene as kernels see it: its buffers, bundled at the door of a kernel.
#ifndef SUN_SCENE_SCENE_H
#define SUN_SCENE_SCENE_H
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
  const SUN_GLOBAL uint *triangle_emitter;
  const SUN_GLOBAL Material *materials;
  const SUN_GLOBAL TextureRef *texture_refs;
  const SUN_GLOBAL Texture *textures;
  const SUN_GLOBAL Emitter *emitters;
  const SUN_GLOBAL Light *lights;
  const SUN_GLOBAL float *tables;
  const SUN_GLOBAL float *environment_texels;
  const SUN_GLOBAL float *environment_cdf;
  TexturePages pages;
} Scene;

// `records` is one buffer of all small tables; the frame says where each begins.
SUN_FN Scene open_scene(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL Vertex *vertices, const SUN_GLOBAL VertexExtra *extras,
                        const SUN_GLOBAL Triangle *triangles, const SUN_GLOBAL Instance *instances, const SUN_GLOBAL uint *records,
                        const SUN_GLOBAL uint *page0, const SUN_GLOBAL uint *page1, const SUN_GLOBAL uint *page2, const SUN_GLOBAL uint *page3) {
  Scene scene;
  scene.frame = frame;
  scene.vertices = vertices;
  scene.extras = extras;
  scene.triangles = triangles;
  scene.instances = instances;
  scene.triangle_emitter = records + frame->at_triangle_emitter;
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
  return scene;
}

// A field of LANES records: GATHER_RECORD(real, scene->materials, index, roughness).
#define GATHER_FLOAT(out, records, index, field)                                    \
  do {                                                                              \
    uint gather_at[LANES];                                                          \
    float gather_value[LANES];                                                      \
    LANES_STORE(index, gather_at);                                                  \
    for (int lane = 0; lane < LANES; lane++) gather_value[lane] = (records)[gather_at[lane]].field; \
    (out) = LANES_LOAD(gather_value);                                               \
  } while (0)
#define GATHER_UINT(out, records, index, field)                                     \
  do {                                                                              \
    uint gather_at[LANES], gather_value[LANES];                                     \
    LANES_STORE(index, gather_at);                                                  \
    for (int lane = 0; lane < LANES; lane++) gather_value[lane] = (records)[gather_at[lane]].field; \
    (out) = LANES_LOAD(gather_value);                                               \
  } while (0)
#define GATHER_VEC3(out, records, index, field)          \
  do {                                                   \
    GATHER_FLOAT((out).x, records, index, field[0]);     \
    GATHER_FLOAT((out).y, records, index, field[1]);     \
    GATHER_FLOAT((out).z, records, index, field[2]);     \
  } while (0)

SUN_NAMESPACE_END
#endif
