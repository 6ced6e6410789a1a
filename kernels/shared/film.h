// SPDX-License-Identifier: Apache-2.0
// The integer film. A contribution x of one channel is rounded once, to a whole number of quanta of the bin that its magnitude names, and added:
//   |x| <  1: bin 0, quantum 2^-36      |x| >= 1: bin 1, quantum 2^-12      |x| > 2^25: clamped and counted; NaN and infinity: dropped and counted
// The rounding is dithered by a hash of (pixel, sample, dimension), so the expected value is x itself. A channel's value is
// bin0 * 2^-36 + bin1 * 2^-12, over the samples. 2^26 contributions fit in either bin.
#ifndef SUN_SHARED_FILM_H
#define SUN_SHARED_FILM_H
#include "shared/types.h"

#define SUN_FILM_FINE_BITS 36
#define SUN_FILM_COARSE_BITS 12
#define SUN_FILM_LIMIT 33554432.0f  // 2^25

// A film is layers x pixels x 3 channels x 2 bins of 64-bit integers: index ((layer * pixels + pixel) * 3 + channel) * 2 + bin.
#define SUN_FILM_CHANNELS 3
#define SUN_FILM_BINS 2

// Layers that every film has. Beauty is their sum; its two halves by the sample's parity give the variance.
#define SUN_LAYER_EVEN 0
#define SUN_LAYER_ODD 1
#define SUN_LAYER_FIRST_OPTIONAL 2

#endif
