// SPDX-License-Identifier: Apache-2.0
// Every result of math/selftest.h, word by word: words[section * SUN_SELFTEST_INPUTS + i].
#include "math/selftest.h"

SUN_KERNEL void sections(__global uint *words) {
  const uint first = get_global_id(0) * LANES;
  if (first >= SUN_SELFTEST_INPUTS) return;
  const uint_n i = first + uint_of_int(LANE_NUMBERS);
  const TestInputs in = test_inputs(i);
  uint lanes[LANES];
  uint section = 0u;
#define SUN_SECTION(name)                                                                                        \
  LANES_STORE(test_of_##name(&in), lanes);                                                                         \
  for (int lane = 0; lane < LANES; lane++) words[section * SUN_SELFTEST_INPUTS + first + lane] = lanes[lane];    \
  section++;
  SUN_SELFTEST_SECTIONS(SUN_SECTION)
}
