// SPDX-License-Identifier: Apache-2.0
#include "flatten/tables.h"

#include <algorithm>
#include <iterator>

#include "math/elementary.h"
#include "shared/tables.h"

namespace sunstone {

namespace {

// Made by make_tables.cpp when the program is built: two seconds that no start has to wait for.
const float energy_tables[] = {
#include "energy_tables.inc"
};
static_assert(std::size(energy_tables) == SUN_TABLE_FILTER - SUN_TABLE_SPLIT_A);

// IEC 61966-2-1.
float linear_of_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : kernel::pow_real((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

std::vector<float> make_tables() {
  std::vector<float> tables(SUN_TABLE_FLOATS);
  for (int byte = 0; byte < 256; byte++) tables[std::size_t(SUN_TABLE_SRGB + byte)] = linear_of_srgb(float(byte) / 255.0f);
  std::copy(std::begin(energy_tables), std::end(energy_tables), tables.begin() + SUN_TABLE_SPLIT_A);
  return tables;
}

}  // namespace sunstone
