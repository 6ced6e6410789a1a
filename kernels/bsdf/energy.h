// SPDX-License-Identifier: Apache-2.0
// Light that one bounce on a microsurface loses, and what gives it back: a lobe f = c (1 - E(o)) (1 - E(i)) / (pi (1 - Emean)) [Kulla17].
// E comes from tables, linear between nodes; their means integrate just that interpolant, so the lobe's own albedo c (1 - E(o)) is exact and
// a white furnace errs by the table's error alone, which host/flatten/make_tables.cpp keeps on the dark side.
#ifndef SUN_BSDF_ENERGY_H
#define SUN_BSDF_ENERGY_H
#include "bsdf/microfacet.h"
#include "shared/tables.h"

SUN_NAMESPACE_BEGIN

// Every axis is linear in the square root of its quantity: losses are steep towards grazing light, smooth surfaces and like media.
SUN_FN real table_axis(real x) { return sqrt(clamp_real(x, (real)(0.0f), (real)(1.0f))); }

// A place on an axis of n nodes over [0, 1]: the lower node, and how far towards the next.
typedef struct TableCell {
  uint_n node;
  real towards;
} TableCell;

SUN_FN TableCell table_cell(real axis, float nodes) {
  real at = axis * (nodes - 1.0f);
  int_n node = int_of_real(min_real(at, (real)(nodes - 2.0f)));
  TableCell cell;
  cell.node = uint_of_int(node);
  cell.towards = at - real_of_int(node);
  return cell;
}

// A node that is met exactly (smooth surfaces lie on the first) needs no neighbour.
SUN_FN real table_linear(const SUN_GLOBAL float *table, uint_n at, real towards) {
  real here = gather_real(table, at);
  if (!ANY(towards != 0.0f)) return here;
  return lerp_real(here, gather_real(table + 1, at), towards);
}
SUN_FN real table_bilinear(const SUN_GLOBAL float *table, uint_n at, uint row, real towards_next, real towards_row) {
  real here = table_linear(table, at, towards_next);
  if (!ANY(towards_row != 0.0f)) return here;
  return lerp_real(here, table_linear(table + row, at, towards_next), towards_row);
}

// Directional albedo of the reflecting lobe: F0 * a + F90 * b; lost = 1 - a - b.
typedef struct Split {
  real a, b, lost;
} Split;

SUN_FN Split make_split(real a, real b) {
  Split s;
  s.a = a;
  s.b = b;
  s.lost = max_real(1.0f - a - b, (real)(0.0f));
  return s;
}
SUN_FN Split split_albedo(const SUN_GLOBAL float *tables, real alpha_axis, real cosine) {
  TableCell i = table_cell(table_axis(cosine), (float)SUN_ENERGY_N), j = table_cell(alpha_axis, (float)SUN_ENERGY_N);
  uint_n at = j.node * (uint)SUN_ENERGY_N + i.node;
  return make_split(table_bilinear(tables + SUN_TABLE_SPLIT_A, at, SUN_ENERGY_N, i.towards, j.towards),
                    table_bilinear(tables + SUN_TABLE_SPLIT_B, at, SUN_ENERGY_N, i.towards, j.towards));
}
SUN_FN Split split_mean(const SUN_GLOBAL float *tables, real alpha_axis) {
  if (!ANY(alpha_axis != 0.0f)) return make_split((real)(tables[SUN_TABLE_SPLIT_A_MEAN]), (real)(tables[SUN_TABLE_SPLIT_B_MEAN]));  // smooth
  TableCell j = table_cell(alpha_axis, (float)SUN_ENERGY_N);
  return make_split(table_linear(tables + SUN_TABLE_SPLIT_A_MEAN, j.node, j.towards),
                    table_linear(tables + SUN_TABLE_SPLIT_B_MEAN, j.node, j.towards));
}

// The share of lost light that comes back reflected, after any number of bounces among the facets: F^2 E / (1 - F (1 - E)) of the means [Kulla17].
SUN_FN real returned_share(real f0, real f90, real mean_lost) {
  real f = f0 + (f90 - f0) * SUN_SCHLICK_MEAN;
  return f * f * (1.0f - mean_lost) / (1.0f - f * mean_lost);
}
SUN_FN vec3 returned_share3(vec3 f0, real f90, real mean_lost) {
  return make_vec3(returned_share(f0.x, f90, mean_lost), returned_share(f0.y, f90, mean_lost), returned_share(f0.z, f90, mean_lost));
}

// Factor of such a lobe: 1 / (pi (1 - Emean)); where nothing is lost the lobe's weights are 0 and any number will do.
SUN_FN real lobe_scale(real mean_lost) { return SUN_INV_PI / max_real(mean_lost, (real)(1e-6f)); }

SUN_NAMESPACE_END
#endif
