// SPDX-License-Identifier: Apache-2.0
// Accessors of the path pool, made from the list of fields: LANES paths at a time, in registers as vectors, in memory as records or columns.
#ifndef SUN_PATH_PATH_H
#define SUN_PATH_PATH_H
#include "math/record.h"
#include "math/sampler.h"
#include "math/vector.h"
#include "shared/path_words.h"
#include "shared/queues.h"

SUN_NAMESPACE_BEGIN

typedef real path_lanes_float;
typedef uint_n path_lanes_uint;
#define PATH_LANES_OF_float(bits) real_of_bits(bits)
#define PATH_LANES_OF_uint(bits) (bits)
#define PATH_BITS_OF_float(value) bits_of_real(value)
#define PATH_BITS_OF_uint(value) (value)

// LANES paths.
typedef struct Path {
#define PATH_FIELD(type, name) path_lanes_##type name;
#include "shared/path_fields.h"
#undef PATH_FIELD
} Path;

// One record of SUN_PATH_WORDS words a slot: one cache line whatever the order of slots. On GPUs a column a field.
typedef struct Paths {
  SUN_GLOBAL uint *words;
  uint pool;
} Paths;

SUN_FN Paths open_paths(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *words) {
  Paths paths;
  paths.words = words;
  paths.pool = frame->pool;
  return paths;
}

SUN_FN uint path_word(const Paths *paths, uint slot, uint field) {
  return SUN_COLUMNS ? field * paths->pool + slot : slot * SUN_PATH_WORDS + field;
}

// Lanes that are switched off have to name a slot of the pool too.
SUN_FN Path path_load(const Paths *paths, uint_n slots) {
  Path path;
  uint_n words[SUN_PATH_WORDS];
  if (SUN_COLUMNS)
    for (uint field = 0; field < SUN_PATH_WORDS; field++) words[field] = gather_uint(paths->words + field * paths->pool, slots);
  else
    load_records(paths->words, slots, words);
#define PATH_FIELD(type, name) path.name = PATH_LANES_OF_##type(words[SUN_PATH_##name]);
#include "shared/path_fields.h"
#undef PATH_FIELD
  return path;
}

// LANES words of a column, such as the status.
SUN_FN void store_uint(SUN_GLOBAL uint *table, uint_n index, mask active, uint_n value) {
  uint at[LANES], word[LANES];
  int on[LANES];
  LANES_STORE(index, at);
  LANES_STORE(value, word);
  LANES_STORE(active, on);
  for (int lane = 0; lane < LANES; lane++)
    if (on[lane]) table[at[lane]] = word[lane];
}

SUN_FN void path_store(const Paths *paths, uint_n slots, mask active, const Path *path) {
  uint_n words[SUN_PATH_WORDS];
#define PATH_FIELD(type, name) words[SUN_PATH_##name] = PATH_BITS_OF_##type(path->name);
#include "shared/path_fields.h"
#undef PATH_FIELD
  if (SUN_COLUMNS)
    for (uint field = 0; field < SUN_PATH_WORDS; field++) store_uint(paths->words + field * paths->pool, slots, active, words[field]);
  else
    store_records(paths->words, slots, active, words);
}

SUN_FN vec3 path_direction(const Path *path) { return make_vec3(path->direction_x, path->direction_y, path->direction_z); }
SUN_FN vec3 path_throughput(const Path *path) { return make_vec3(path->throughput_r, path->throughput_g, path->throughput_b); }

SUN_FN void path_set_throughput(Path *path, vec3 throughput) {
  path->throughput_r = throughput.x;
  path->throughput_g = throughput.y;
  path->throughput_b = throughput.z;
}

// Another ray for the lanes in `on`.
SUN_FN void path_aim(Path *path, mask on, vec3 origin, vec3 direction) {
  path->origin_x = on ? origin.x : path->origin_x;
  path->origin_y = on ? origin.y : path->origin_y;
  path->origin_z = on ? origin.z : path->origin_z;
  path->direction_x = on ? direction.x : path->direction_x;
  path->direction_y = on ? direction.y : path->direction_y;
  path->direction_z = on ? direction.z : path->direction_z;
}

#define SUN_PHOTON_KEY 0x7068f070u

// The random numbers of samples of pixels, which count within the tile. The photons of an iteration are points of one sequence, so that they are spread well over the
// lights: `pixel` is their number, `sample` the iteration.
SUN_FN SamplerKey pixel_key(const SUN_GLOBAL Frame *frame, uint_n pixel, uint_n sample) {
  if (frame->flags & SUN_FRAME_PHOTONS) {
    SamplerKey key;
    key.pixel_hash = hash3((uint_n)(frame->seed), (uint_n)(SUN_PHOTON_KEY), sample);
    key.sample = pixel;
    key.kind = frame->sampler;
    return key;
  }
  uint_n y = pixel / (uint_n)(frame->tile_width);
  uint_n x = pixel - y * (uint_n)(frame->tile_width);
  return sampler_key(frame->seed, x + (uint_n)(frame->tile_x0), y + (uint_n)(frame->tile_y0), sample, frame->sampler);
}
SUN_FN SamplerKey path_key(const SUN_GLOBAL Frame *frame, const Path *path) { return pixel_key(frame, path->pixel, path->sample); }

SUN_NAMESPACE_END
#endif
