// SPDX-License-Identifier: Apache-2.0
// Fixed-size names for kernels and for C++. Everything under kernels/ is in namespace sunstone::kernel when compiled as C++.
#ifndef SUN_SHARED_TYPES_H
#define SUN_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#define SUN_NAMESPACE_BEGIN namespace sunstone::kernel {
#define SUN_NAMESPACE_END }
#define SUN_GLOBAL
#define SUN_UNROLL
#define SUN_CONSTANT static const
#define SUN_STATIC_ASSERT(condition, name) static_assert(condition, #name)
SUN_NAMESPACE_BEGIN
using uint = std::uint32_t;
using ushort = std::uint16_t;
using uchar = std::uint8_t;
using ulong = std::uint64_t;
SUN_NAMESPACE_END
#else
#pragma OPENCL FP_CONTRACT OFF
#define SUN_NAMESPACE_BEGIN
#define SUN_NAMESPACE_END
#define SUN_GLOBAL __global
// Before every loop over the elements of an array that is to stay in registers: PoCL unrolls none unasked, and what a loop indexes stands in memory, all that
// is in one struct with it too.
#define SUN_UNROLL _Pragma("unroll")
#define SUN_CONSTANT __constant
#define SUN_STATIC_ASSERT(condition, name) typedef char static_assert_##name[(condition) ? 1 : -1]
#endif

// A helper of the kernels; never an entry point.
#define SUN_FN static inline
// One that takes the address of what has to stay in registers: called, it would keep that in memory (a third of a traversal's speed).
#define SUN_INLINE static inline __attribute__((always_inline))

#define SUN_NONE 0xffffffffu  // "no index", in every table

#endif
