// SPDX-License-Identifier: Apache-2.0
// The small tables of kernels/shared/tables.h.
#pragma once
#include <vector>

namespace sunstone {

// SUN_TABLE_FLOATS floats. The filter's part is zero: the pipeline fills it.
std::vector<float> make_tables();

}  // namespace sunstone
