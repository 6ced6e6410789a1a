// SPDX-License-Identifier: Apache-2.0
// Path number -> (sample, block of 4x4 pixels, pixel of the block): neighbours in the queue look the same way, and a launch can end after any sample.
#ifndef SUN_PATH_NUMBER_H
#define SUN_PATH_NUMBER_H
#include "math/real.h"
#include "shared/frame.h"

SUN_NAMESPACE_BEGIN

typedef struct PathNumber {
  uint_n sample;
  uint_n x, y;                  // within the tile ...
  uint_n picture_x, picture_y;  // ... and in the whole picture
  mask inside;                  // else beyond the tile's edge: numbers count whole blocks
} PathNumber;

// Pixel `within` of a block.
SUN_FN PathNumber path_in_block(const SUN_GLOBAL Frame *frame, uint_n sample, uint_n block_x, uint_n block_y, uint_n within) {
  PathNumber path;
  path.sample = (uint_n)(frame->sample_first) + sample;
  path.x = block_x * (uint_n)(4) + (within & (uint_n)(3));
  path.y = block_y * (uint_n)(4) + (within >> (uint_n)(2));
  path.picture_x = path.x + (uint_n)(frame->tile_x0);
  path.picture_y = path.y + (uint_n)(frame->tile_y0);
  path.inside = (path.x < (uint_n)(frame->tile_width)) & (path.y < (uint_n)(frame->tile_height));
  return path;
}

SUN_FN PathNumber path_number(const SUN_GLOBAL Frame *frame, uint_n number) {
  uint_n of_sample = number / (uint_n)(frame->paths_per_sample);
  uint_n rest = number - of_sample * (uint_n)(frame->paths_per_sample);
  uint_n block = rest >> (uint_n)(4);
  uint blocks_across = (frame->tile_width + 3) / 4;
  uint_n block_y = block / (uint_n)(blocks_across);
  return path_in_block(frame, of_sample, block - block_y * (uint_n)(blocks_across), block_y, rest & (uint_n)(15));
}

// LANES numbers from `first` on, a multiple of LANES: all of one block, so nothing is divided lane by lane.
SUN_FN PathNumber path_numbers_from(const SUN_GLOBAL Frame *frame, uint first) {
  uint of_sample = first / frame->paths_per_sample, rest = first - of_sample * frame->paths_per_sample;
  uint block = rest >> 4, blocks_across = (frame->tile_width + 3) / 4, block_y = block / blocks_across;
  uint_n within = (uint_n)(rest & 15u) + uint_of_int((int_n)(LANE_NUMBERS));
  return path_in_block(frame, (uint_n)(of_sample), (uint_n)(block - block_y * blocks_across), (uint_n)(block_y), within);
}

SUN_NAMESPACE_END
#endif
