// SPDX-License-Identifier: Apache-2.0
// One buffer of floats holds every small table; this is where each begins. host/flatten/tables.cpp fills it.
#ifndef SUN_SHARED_TABLES_H
#define SUN_SHARED_TABLES_H

#define SUN_TABLE_SRGB 0  // 256: sRGB byte -> linear

// Directional albedos of the GGX lobe with Smith's height-correlated masking, for energy compensation. cos at cell i: (i / (N - 1))^2; roughness
// alpha at cell j: (j / (N - 1))^2. Index: j * N + i. See bsdf/energy.h.
#define SUN_ENERGY_N 32
#define SUN_TABLE_SPLIT_A 256                                            // scale of F0: integral of (1 - (1-VdotH)^5) f cos
#define SUN_TABLE_SPLIT_B (SUN_TABLE_SPLIT_A + SUN_ENERGY_N * SUN_ENERGY_N)  // scale of F90: integral of (1-VdotH)^5 f cos
#define SUN_TABLE_SPLIT_A_MEAN (SUN_TABLE_SPLIT_B + SUN_ENERGY_N * SUN_ENERGY_N)  // N: 2 * integral over cos of cos * A
#define SUN_TABLE_SPLIT_B_MEAN (SUN_TABLE_SPLIT_A_MEAN + SUN_ENERGY_N)

// Rough dielectric (reflection and refraction together): single-scattering albedo. Index: ((side * M + eta) * M + alpha) * M + cos;
// side 0: from the outside, 1: from the inside; see bsdf/dielectric.h for the spacing.
#define SUN_GLASS_N 16
#define SUN_TABLE_GLASS (SUN_TABLE_SPLIT_B_MEAN + SUN_ENERGY_N)
#define SUN_TABLE_GLASS_MEAN (SUN_TABLE_GLASS + 2 * SUN_GLASS_N * SUN_GLASS_N * SUN_GLASS_N)  // (side * M + eta) * M + alpha

#define SUN_TABLE_FILTER (SUN_TABLE_GLASS_MEAN + 2 * SUN_GLASS_N * SUN_GLASS_N)  // SUN_FILTER_TABLE + 1: inverse cdf of |f|, in pixels
#define SUN_TABLE_FLOATS (SUN_TABLE_FILTER + 1025)

#endif
