// SPDX-License-Identifier: Apache-2.0
// Weights of all strategies of a path by two numbers that each walk carries, instead of a sum over the path [Georgiev12]. For the walk's last vertex
//   dVCM  the density of its own strategy that would stop a vertex earlier, over that of the walk
//   dVC   the densities of all strategies that would stop earlier still, over that of the walk and, left out, the density of the way back here
// both by area. Ratios enter as they are (balance heuristic), or squared (power heuristic). Where the light vertices of all subpaths are looked at (SUN_MERGING), a path can
// also be made by merging the two walks at any vertex that is no delta: as by joining, in a disk that is met by chance instead of one point, and with the subpaths of all pixels.
//   dVM   the densities of all strategies that would stop earlier, over that of merging in the last vertex, and without the density of the way back here
// A weight may be any division of 1 among the strategies that can make a path, so what all of them leave out alike does no harm: roulette, coins of alpha,
// the chance of a side, the filter. Cosines are those of the true surface, as areas are.
#ifndef SUN_TRANSPORT_VERTEX_WEIGHTS_H
#define SUN_TRANSPORT_VERTEX_WEIGHTS_H
#include "path/walk.h"
#include "shared/frame.h"

SUN_NAMESPACE_BEGIN

#define SUN_LARGEST_RATIO 1e30f
#define SUN_LEAST_COSINE 1e-6f

// A ratio of densities as it enters a sum.
SUN_FN real heuristic_ratio(const SUN_GLOBAL Frame *frame, real ratio) {
  real r = (frame->flags & SUN_FRAME_BALANCE) ? ratio : ratio * ratio;
  return r < SUN_LARGEST_RATIO ? r : (real)(SUN_LARGEST_RATIO);
}

// How much denser merging in a vertex is than joining it: the number of light subpaths times the disk's area [Georgiev12 eq. 20, etaVCM].
SUN_FN real merging_ratio(const SUN_GLOBAL Frame *frame) { return heuristic_ratio(frame, (real)(frame->merges)); }

// All strategies that would stop earlier than the last vertex, over the walk's own, once the density of the way here is known: times that it is a walk's half of a weight.
// Every part is finite, so that nothing is 0 times infinity.
SUN_FN real earlier_strategies(const SUN_GLOBAL Frame *frame, real dVCM, real dVC, real pdf_reverse) {
  real earlier = dVCM + dVC * heuristic_ratio(frame, pdf_reverse);
  if (SUN_MERGING) earlier = earlier + merging_ratio(frame);  // in that vertex
  return min_real(earlier, (real)(SUN_LARGEST_RATIO));
}

// The same over merging in the last vertex [Georgiev12 eq. 38, 39].
SUN_FN real earlier_than_merging(const SUN_GLOBAL Frame *frame, real dVCM, real dVM, real pdf_reverse) {
  return min_real(dVCM / merging_ratio(frame) + dVM * heuristic_ratio(frame, pdf_reverse), (real)(SUN_LARGEST_RATIO));
}

// The walk's ray has hit a surface, under this cosine [Georgiev12 eq. 31-36: the factors that wait for the hit].
SUN_FN void weights_arrive(const SUN_GLOBAL Frame *frame, Walk *walk, real distance, real cosine) {
  real far2 = heuristic_ratio(frame, distance * distance), facing = heuristic_ratio(frame, max_real(fabs(cosine), (real)(SUN_LEAST_COSINE)));
  walk->dVCM = min_real((walk->far ? walk->dVCM : walk->dVCM * far2) / facing, (real)(SUN_LARGEST_RATIO));
  walk->dVC = min_real(walk->dVC / facing, (real)(SUN_LARGEST_RATIO));
  if (SUN_MERGING) walk->dVM = min_real(walk->dVM / facing, (real)(SUN_LARGEST_RATIO));
}

// It leaves with density pdf, under this cosine; the other walk would come back along its last segment with density pdf_reverse [Georgiev12 eq. 35, 36].
SUN_FN void weights_scatter(const SUN_GLOBAL Frame *frame, Walk *walk, mask scatters, real pdf, real pdf_reverse, real cosine) {
  real safe = (scatters & (pdf > 0.0f)) ? pdf : (real)(1.0f);
  real onwards = heuristic_ratio(frame, fabs(cosine) / safe);
  real dVC = onwards * earlier_strategies(frame, walk->dVCM, walk->dVC, pdf_reverse);
  if (SUN_MERGING) {
    real dVM = onwards * (1.0f + earlier_than_merging(frame, walk->dVCM, walk->dVM, pdf_reverse));
    walk->dVM = scatters ? min_real(dVM, (real)(SUN_LARGEST_RATIO)) : walk->dVM;
  }
  walk->dVC = scatters ? min_real(dVC, (real)(SUN_LARGEST_RATIO)) : walk->dVC;
  walk->dVCM = scatters ? heuristic_ratio(frame, 1.0f / safe) : walk->dVCM;
  walk->far = walk->far & !scatters;
}

// It leaves along a delta direction: no strategy joins here. `ratio` is the chance of the way back over that of this one, with the squeeze of solid angles where it is bent;
// `cosine` that of the arrival, which cancels.
SUN_FN void weights_delta(const SUN_GLOBAL Frame *frame, Walk *walk, mask scatters, real ratio, real cosine) {
  real facing = heuristic_ratio(frame, max_real(fabs(cosine), (real)(SUN_LEAST_COSINE))), back = heuristic_ratio(frame, ratio);
  walk->dVC = scatters ? min_real(walk->dVC * facing * back, (real)(SUN_LARGEST_RATIO)) : walk->dVC;
  if (SUN_MERGING) walk->dVM = scatters ? min_real(walk->dVM * facing * back, (real)(SUN_LARGEST_RATIO)) : walk->dVM;
  walk->dVCM = scatters ? (real)(0.0f) : walk->dVCM;
  walk->far = walk->far & !scatters;
}

// Of one path by strategy (s, t), the ratios of all others from the light's side and from the eye's being these sums. `t` is a number of vertices, and so is `s`.
SUN_FN real strategy_weight(const SUN_GLOBAL Frame *frame, uint_n s, uint_n t, real from_light, real from_eye) {
  real weight = 1.0f / (1.0f + from_light + from_eye);
  if (frame->flags & SUN_FRAME_UNWEIGHTED) weight = (real)(1.0f);
  if (frame->strategy_t != SUN_NONE) weight = ((s == (uint_n)(frame->strategy_s)) & (t == (uint_n)(frame->strategy_t))) ? weight : (real)(0.0f);
  return weight;
}

// The walk turned, as `left` says.
SUN_FN void weights_turn(Walk *walk, const Walk *left, mask turned) {
  walk->dVCM = turned ? left->dVCM : walk->dVCM;
  walk->dVC = turned ? left->dVC : walk->dVC;
  if (SUN_MERGING) walk->dVM = turned ? left->dVM : walk->dVM;
  walk->far = walk->far & !turned;
}

SUN_NAMESPACE_END
#endif
