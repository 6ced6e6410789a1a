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

SUN_FN PathNumber path_number(const SUN_GLOBAL Frame *frame, uint_n number) {
  PathNumber path;
  uint_n of_sample = number / (uint_n)(frame->paths_per_sample);
  path.sample = (uint_n)(frame->sample_first) + of_sample;
  uint_n rest = number - of_sample * (uint_n)(frame->paths_per_sample);
  uint_n within = rest & (uint_n)(15);
  uint_n block = rest >> (uint_n)(4);
  uint blocks_across = (frame->tile_width + 3) / 4;
  uint_n block_y = block / (uint_n)(blocks_across);
  uint_n block_x = block - block_y * (uint_n)(blocks_across);
  path.x = block_x * (uint_n)(4) + (within & (uint_n)(3));
  path.y = block_y * (uint_n)(4) + (within >> (uint_n)(2));
  path.picture_x = path.x + (uint_n)(frame->tile_x0);
  path.picture_y = path.y + (uint_n)(frame->tile_y0);
  path.inside = (path.x < (uint_n)(frame->tile_width)) & (path.y < (uint_n)(frame->tile_height));
  return path;
}

SUN_NAMESPACE_END
#endif
