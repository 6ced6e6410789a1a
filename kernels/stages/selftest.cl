// SPDX-License-Identifier: Apache-2.0
// selftest: runs each section of math/selftest.h over its inputs.
//   writes   sums: [section * SUN_SELFTEST_ITEMS + item], the item's part of the section's sum
//   launch   SUN_SELFTEST_ITEMS work-items
#include "math/selftest.h"

#define SUN_SELFTEST_ITEMS 64u

static uint sum_of_lanes(uint_n v) {
  uint lanes[LANES];
  uint sum = 0u;
  LANES_STORE(v, lanes);
  for (int lane = 0; lane < LANES; lane++) sum += lanes[lane];
  return sum;
}

SUN_KERNEL void selftest(__global uint *sums) {
  const uint item = get_global_id(0);
  if (item >= SUN_SELFTEST_ITEMS) return;
  const uint steps = SUN_SELFTEST_INPUTS / (SUN_SELFTEST_ITEMS * LANES);
  const uint first = item * steps * LANES;
#define SUN_SECTION(name) uint_n sum_##name = (uint_n)(0u);
  SUN_SELFTEST_SECTIONS(SUN_SECTION)
#undef SUN_SECTION
  for (uint step = 0u; step < steps; step++) {
    const uint_n i = first + step * LANES + uint_of_int(LANE_NUMBERS);
    const TestInputs in = test_inputs(i);
#define SUN_SECTION(name) sum_##name += test_term(i, test_of_##name(&in));
    SUN_SELFTEST_SECTIONS(SUN_SECTION)
#undef SUN_SECTION
  }
  __global uint *out = sums + item;
#define SUN_SECTION(name)         \
  *out = sum_of_lanes(sum_##name); \
  out += SUN_SELFTEST_ITEMS;
  SUN_SELFTEST_SECTIONS(SUN_SECTION)
#undef SUN_SECTION
}
