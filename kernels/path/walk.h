// SPDX-License-Identifier: Apache-2.0
// What a walk of a bidirectional method needs beside its path: a record of 16 words a slot, whatever the layout of paths.
#ifndef SUN_PATH_WALK_H
#define SUN_PATH_WALK_H
#include "math/record.h"
#include "math/vector.h"
#include "shared/bidirectional.h"

SUN_NAMESPACE_BEGIN

// LANES of them; the words are named in shared/bidirectional.h.
typedef struct Walk {
  real dVCM, dVC, dVM;
  vec3 emitted, absorption;
  uint_n vertices, rough, path;
  mask far, holds, unseen;
} Walk;

SUN_FN Walk walk_load(const SUN_GLOBAL uint *walks, uint_n slots) {
  uint_n words[SUN_WALK_WORDS];
  load_records(walks, slots, words);
  Walk walk;
  walk.dVCM = real_of_bits(words[SUN_WALK_dVCM]);
  walk.dVC = real_of_bits(words[SUN_WALK_dVC]);
  walk.dVM = real_of_bits(words[SUN_WALK_dVM]);
  walk.vertices = words[SUN_WALK_VERTICES];
  walk.rough = words[SUN_WALK_ROUGH];
  walk.path = words[SUN_WALK_PATH];
  walk.far = words[SUN_WALK_FAR] != (uint_n)(0);
  walk.unseen = words[SUN_WALK_UNSEEN] != (uint_n)(0);
  walk.holds = words[SUN_WALK_HOLDS] != (uint_n)(0);
  walk.emitted = make_vec3(real_of_bits(words[SUN_WALK_EMITTED]), real_of_bits(words[SUN_WALK_EMITTED + 1]), real_of_bits(words[SUN_WALK_EMITTED + 2]));
  walk.absorption = make_vec3(real_of_bits(words[SUN_WALK_ABSORPTION]), real_of_bits(words[SUN_WALK_ABSORPTION + 1]), real_of_bits(words[SUN_WALK_ABSORPTION + 2]));
  return walk;
}

SUN_FN void walk_store(SUN_GLOBAL uint *walks, uint_n slots, mask active, const Walk *walk) {
  uint_n words[SUN_WALK_WORDS];
  SUN_UNROLL
  for (int k = 0; k < SUN_WALK_WORDS; k++) words[k] = (uint_n)(0);
  words[SUN_WALK_dVCM] = bits_of_real(walk->dVCM);
  words[SUN_WALK_dVC] = bits_of_real(walk->dVC);
  words[SUN_WALK_dVM] = bits_of_real(walk->dVM);
  words[SUN_WALK_VERTICES] = walk->vertices;
  words[SUN_WALK_ROUGH] = walk->rough;
  words[SUN_WALK_PATH] = walk->path;
  words[SUN_WALK_UNSEEN] = walk->unseen ? (uint_n)(1) : (uint_n)(0);
  words[SUN_WALK_HOLDS] = walk->holds ? (uint_n)(1) : (uint_n)(0);
  words[SUN_WALK_FAR] = walk->far ? (uint_n)(1) : (uint_n)(0);
  words[SUN_WALK_EMITTED] = bits_of_real(walk->emitted.x);
  words[SUN_WALK_EMITTED + 1] = bits_of_real(walk->emitted.y);
  words[SUN_WALK_EMITTED + 2] = bits_of_real(walk->emitted.z);
  words[SUN_WALK_ABSORPTION] = bits_of_real(walk->absorption.x);
  words[SUN_WALK_ABSORPTION + 1] = bits_of_real(walk->absorption.y);
  words[SUN_WALK_ABSORPTION + 2] = bits_of_real(walk->absorption.z);
  store_records(walks, slots, active, words);
}

SUN_NAMESPACE_END
#endif
