// SPDX-License-Identifier: Apache-2.0
// Constants of a launch: the camera, the picture, the samples, the counts of the scene.
#ifndef SUN_SHARED_FRAME_H
#define SUN_SHARED_FRAME_H
#include "shared/emitter.h"
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

#define SUN_CAMERA_PERSPECTIVE 0
#define SUN_CAMERA_ORTHOGRAPHIC 1

// Film position (x, y) in pixels, y down -> s = (2x/width - 1, 1 - 2y/height).
// Perspective: direction = forward + s.x * right + s.y * up (right and up scaled by the half angles' tangents); the ray starts at the lens.
// Orthographic: origin = position + s.x * right + s.y * up (scaled by the half sizes), direction = forward.
typedef struct Camera {
  float position[3];
  uint kind;
  float right[3];
  float lens_radius;     // metres; 0 is a pinhole
  float up[3];
  float focus_distance;  // along forward
  float forward[3];      // unit length
  float pad;
} Camera;
SUN_STATIC_ASSERT(sizeof(Camera) == 64, camera_is_64_bytes);

#define SUN_SAMPLER_SOBOL 0
#define SUN_SAMPLER_INDEPENDENT 1

// Flags of a frame.
#define SUN_FRAME_TRANSPARENT 1u   // camera rays that leave the scene add nothing
#define SUN_FRAME_DIRECT 2u        // shade sends shadow rays to emitters
#define SUN_FRAME_EXTRAS 4u        // VertexExtra[] is as long as Vertex[]
#define SUN_FRAME_WEIGHTED 8u      // shadow rays and emitters that are hit share their worth by the power heuristic; else each light has one of the two
#define SUN_FRAME_FIRST 16u        // shadow rays leave from the camera ray's hit alone
#define SUN_FRAME_TWICE 32u        // wrong on purpose: emitters that are hit count in full beside shadow rays
#define SUN_FRAME_BALANCE 256u     // bidirectional weights: the balance heuristic; else the power heuristic
#define SUN_FRAME_UNWEIGHTED 512u  // each strategy by itself, as if there were no other
#define SUN_FRAME_LIGHT_PASS 4096u  // light subpaths alone: a slot that has walked one is free
#define SUN_FRAME_PHOTONS 8192u     // they are photons: numbered by themselves and not by pixels, stored from their second hit on, and lit by all of a sky
#define SUN_FRAME_FINAL_GATHER 16384u // eye paths look at the map of all photons one ray after the first matt surface, and there at that of caustics
#define SUN_FRAME_EYE_PASS 32768u   // eye subpaths alone: their light subpaths have been walked
#define SUN_FRAME_END_ON_LIGHT 64u // a path ends on the emitter that it hits
#define SUN_FRAME_ONE_TIME 1024u   // all pixels take the same time of the shutter for the same sample number
#define SUN_FRAME_CAMERA_MOVES 2048u  // cameras for all keys of the shutter's time stand behind the frame
#define SUN_FRAME_EFFECTS 128u     // rays leave a vertex by effect: what facets reflect and what they transmit, each followed; nothing else is

// How directions are drawn: as the bsdf asks, or without a look at it (what is no delta): with a cosine, or evenly.
#define SUN_SAMPLING_BSDF 0u
#define SUN_SAMPLING_COSINE 1u
#define SUN_SAMPLING_UNIFORM 2u
#define SUN_MOST_LIGHT_SAMPLES 64
#define SUN_MOST_INDIRECT_SAMPLES 1024

#define SUN_WHITTED_DEPTH 32  // the most that `whitted` takes: as many rays of a tree may wait

#define SUN_FILTER_TABLE 1024  // cells of the filter's inverse cdf

typedef struct Frame {
  Camera camera;
  Environment environment;
  uint width, height;            // of the whole picture
  uint tile_x0, tile_y0;         // the tile that this film covers
  uint tile_width, tile_height;
  uint sample_first;             // of this launch
  uint paths_per_sample;         // pixels of the tile, rounded up to whole blocks of 4x4
  uint seed;
  uint sampler;
  uint max_depth;
  uint roulette_depth;           // scatterings after which roulette begins
  uint emitter_count;
  uint instance_count;           // that trees know; plane_count infinite planes stand behind them
  uint layer_bounce;             // film layers (shared/film.h): bounce.0, or SUN_NONE where bounces are not kept; bounce_layers of them
  uint bounce_layers;
  uint layer_albedo, layer_normal, layer_depth, layer_position, layer_object, layer_material;  // or SUN_NONE
  uint pool;                     // slots
  uint flags;
  float filter_radius;           // pixels; 0: box of one pixel
  float filter_weight;           // integral |f| / integral f: 1 where f is nowhere negative
  float scene_radius;            // half the diagonal of the scene's bounds; reaches beyond every surface from its centre
  float scene_center[3];
  uint layer_alpha;
  // Where each table begins in the buffer of records, in words (path: pipeline/upload.cpp).
  uint at_triangle_emitter, at_materials, at_texture_refs, at_textures;
  uint at_emitters, at_lights, at_tables, at_environment_texels;
  uint at_environment_cdf;
  float filter_negative_from;    // |offset| beyond which the filter's factor is negative; beyond the radius for all but Mitchell
  uint at_triangle_object, at_instance_object;
  uint sampling;                 // SUN_SAMPLING_: how directions are drawn
  uint light_samples;            // shadow rays a vertex
  float absorption;              // chance to end at each scattering, whatever the throughput; negative: by the throughput
  uint indirect_samples;         // rays that leave a vertex
  uint strategy_s, strategy_t;   // bidirectional: vertices from the light's side and from the eye's, of the one strategy that counts; SUN_NONE: all
  uint plane_count;
  uint light_count;              // punctual ones, for integrators that ask each of them
  float cutoff;                  // a ray whose worth is below this is not followed
  float ambient[3];              // radiance that is about in all places, for what scatters it diffusely
  uint motion_steps;             // keys less one while the shutter is open; 0: all is still
  uint light_paths;              // of a light pass whose vertices are gathered
  float merges;                  // where walks merge: light subpaths times the area of the disk in which they do
  uint first_shape;              // instances from there on are shapes, those with bounds before the planes
  float lower[3], upper[3];      // bounds of all instances that trees know
  uint pad[3];
} Frame;
SUN_STATIC_ASSERT(sizeof(Frame) % 16 == 0, frame_is_whole_words);

SUN_NAMESPACE_END
#endif
