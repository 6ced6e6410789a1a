// SPDX-License-Identifier: Apache-2.0
// The tree of rays of one sample, walked depth first: a slot has one ray in flight, and beneath it a stack of vertices that have children to come.
// The room of a slot: a record of its state, then two records for each vertex of the stack: the path as it arrived there, and the rest.
#ifndef SUN_TRANSPORT_BRANCH_H
#define SUN_TRANSPORT_BRANCH_H
#include "math/sampler.h"
#include "path/path.h"
#include "scene/surface.h"
#include "shared/frame.h"

SUN_NAMESPACE_BEGIN

// The tree walked by LANES slots. All zero, as at the start of a sample, where nothing branches.
typedef struct BranchState {
  uint_n height;  // vertices on the stack
  uint_n branch;  // which way through the tree led here: 0 by first children alone, else a hash
} BranchState;

SUN_FN uint_n branch_record(const SUN_GLOBAL Frame *frame, uint_n slots) { return slots * (uint_n)(SUN_BRANCH_RECORDS(frame->max_depth)); }

SUN_FN BranchState load_branch_state(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *branches, uint_n slots) {
  BranchState state;
  uint_n at = branch_record(frame, slots) * (uint_n)(16);
  state.height = gather_uint(branches, at);
  state.branch = gather_uint(branches, at + (uint_n)(1));
  return state;
}

SUN_FN void store_branch_state(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *branches, uint_n slots, mask on, const BranchState *state) {
  uint_n at = branch_record(frame, slots) * (uint_n)(16);
  store_uint(branches, at, on, state->height);
  store_uint(branches, at + (uint_n)(1), on, state->branch);
}

// Which way a child goes. The first child goes on as if nothing had branched.
SUN_FN uint_n branch_of_child(uint_n branch, uint_n vertex, uint_n child) {
  return child == (uint_n)(0) ? branch : hash3(branch, vertex, child) | (uint_n)(1);
}

// Random numbers of a branch: those of the pixel where it is the first way, others elsewhere, each branch with a sequence of its own.
SUN_FN SamplerKey branch_key(SamplerKey key, uint_n branch) {
  key.pixel_hash = branch == (uint_n)(0) ? key.pixel_hash : hash_step(key.pixel_hash, branch);
  return key;
}

// The rays that leave a vertex.
typedef struct Children {
  uint_n count;
  uint_n sharing;  // of the child in question: how many share what it stands for,
  uint_n number;   // and its number among those
  mask through;    // of effects: it follows what facets transmit, not what they reflect
} Children;

// Child `child` of LANES vertices. Without effects `frame->indirect_samples` rays, any way that the bsdf has; with them as many for each effect that blurs. Mirrors
// and smooth glass, where further rays would go the same way, send one. `limited`: at the depth limit, where a ray may still go straight on. `below`: vertices that wait
// beneath. Of effects these are fewer than the depth, as the last child of a vertex leaves none waiting, and no other goes straight on; other rays that do are
// bounded: with a full stack one is sent.
SUN_FN Children vertex_children(const SUN_GLOBAL Frame *frame, const Lobes *lobes, uint_n child, uint_n below, mask limited) {
  const uint_n none = (uint_n)(0), one = (uint_n)(1), several = (uint_n)(frame->indirect_samples);
  Children c;
  if (frame->flags & SUN_FRAME_EFFECTS) {
    mask facets = lobes->pick_facets > 0.0f;
    mask clear = facets & (max_real(max_of3(lobes->glass_tint), max_real(max_of3(lobes->t0), max_of3(lobes->t90))) > 0.0f);
    uint_n reflected = (facets & !limited) ? (lobes->delta_reflection ? one : several) : none;
    uint_n transmitted = clear ? ((lobes->delta_transmission | limited) ? one : several) : none;
    c.count = reflected + transmitted;
    c.through = child >= reflected;
    c.sharing = c.through ? transmitted : reflected;
    c.number = c.through ? child - reflected : child;
  } else {
    mask blurs = !(lobes->delta_reflection | lobes->delta_transmission) | (lobes->pick_facets < 1.0f);
    c.count = (blurs & !limited & (below < (uint_n)(frame->max_depth))) ? several : one;
    c.through = limited & !limited;
    c.sharing = c.count;
    c.number = child;
  }
  return c;
}

// A vertex with children to come.
typedef struct BranchVertex {
  Path path;       // as it arrived: the ray, and the throughput before this hit
  HitLanes hit;
  uint_n branch;   // of the vertex
  uint_n child;    // the next one's number
  uint_n word;     // depth
} BranchVertex;

SUN_FN void store_branch_vertex(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *branches, uint_n slots, mask on, uint_n place, const BranchVertex *v) {
  uint_n record = branch_record(frame, slots) + (uint_n)(1) + (on ? place : (uint_n)(0)) * (uint_n)(2);
  uint_n words[16];
#define PATH_FIELD(type, name) words[SUN_PATH_##name] = PATH_BITS_OF_##type(v->path.name);
#include "shared/path_fields.h"
#undef PATH_FIELD
  store_records(branches, record, on, words);
  SUN_UNROLL
  for (int k = 0; k < 16; k++) words[k] = (uint_n)(0);
  words[0] = bits_of_real(v->hit.t);
  words[1] = bits_of_real(v->hit.u);
  words[2] = bits_of_real(v->hit.v);
  words[3] = v->hit.instance;
  words[4] = v->hit.primitive;
  words[5] = v->branch;
  words[6] = v->child;
  words[7] = v->word;
  store_records(branches, record + (uint_n)(1), on, words);
}

SUN_FN BranchVertex load_branch_vertex(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *branches, uint_n slots, mask on, uint_n place) {
  BranchVertex v;
  uint_n record = branch_record(frame, slots) + (uint_n)(1) + (on ? place : (uint_n)(0)) * (uint_n)(2);
  uint_n words[16];
  load_records(branches, record, words);
#define PATH_FIELD(type, name) v.path.name = PATH_LANES_OF_##type(words[SUN_PATH_##name]);
#include "shared/path_fields.h"
#undef PATH_FIELD
  load_records(branches, record + (uint_n)(1), words);
  v.hit.t = real_of_bits(words[0]);
  v.hit.u = real_of_bits(words[1]);
  v.hit.v = real_of_bits(words[2]);
  v.hit.instance = words[3];
  v.hit.primitive = words[4];
  v.hit.hit = on;
  v.branch = words[5];
  v.child = words[6];
  v.word = words[7];
  return v;
}

SUN_NAMESPACE_END
#endif
