// SPDX-License-Identifier: Apache-2.0
// Every switch of the kernels, its values and its default. The host sets them with -D; none of them changes a bit of a result.
#ifndef SUN_SHARED_OPTIONS_H
#define SUN_SHARED_OPTIONS_H

// Paths that one work-item of a shading stage carries in vector variables: 1, 8 or 16.
#ifndef LANES
#define LANES 1
#endif

// Layout of the BVH: which traverse_*.h answers.
#define SUN_LAYOUT_BINARY 0
#define SUN_LAYOUT_WIDE8 1
#define SUN_LAYOUT_WIDE16 2
#ifndef SUN_LAYOUT
#define SUN_LAYOUT SUN_LAYOUT_BINARY
#endif

// 1: a path's fields stand in columns (GPUs), 0: in records of one cache line (CPUs).
#ifndef SUN_COLUMNS
#define SUN_COLUMNS 0
#endif

// Queue entries that one work-item of compact owns: long on CPUs, short on GPUs.
#ifndef SUN_CHUNK
#define SUN_CHUNK 1024
#endif

// 1 where the scene has triangles that shadow rays may pass: alpha, smooth thin transmission.
#ifndef SUN_PASSABLE
#define SUN_PASSABLE 1
#endif

// 1 where the scene has analytic shapes: spheres, disks, quads, planes.
#ifndef SUN_SHAPES
#define SUN_SHAPES 1
#endif

// 0 where the scene is still while the shutter is open; 1 where instances, lights or the camera move; 2 where vertices do, too.
#ifndef SUN_MOTION
#define SUN_MOTION 2
#endif
#define SUN_DEFORMING (SUN_MOTION > 1)
// 1 where it has few of them: a kernel that has LANES rays to trace asks each shape for all of them, and the tree for triangles alone; 1 where the scene has
// such triangles at all.
#ifndef SUN_FEW_SHAPES
#define SUN_FEW_SHAPES 0
#endif
#ifndef SUN_TRIANGLES
#define SUN_TRIANGLES 1
#endif

// 1 where the scene has anything but diffuse surfaces; 1 where it has textures, or colours of vertices. 0 leaves the code out: compiled sooner, the same bits.
#ifndef SUN_SPECULAR
#define SUN_SPECULAR 1
#endif
#ifndef SUN_TEXTURES
#define SUN_TEXTURES 1
#endif

// 1 where several rays may leave a vertex.
#ifndef SUN_BRANCHING
#define SUN_BRANCHING 0
#endif

// 1 where walks start from the lights too (shared/bidirectional.h).
#ifndef SUN_BIDIRECTIONAL
#define SUN_BIDIRECTIONAL 0
#endif

// 1 where eye paths look at photons.
#ifndef SUN_PHOTONS
#define SUN_PHOTONS 0
#endif

// 1 where eye subpaths merge with the light subpaths of all pixels, beside joining their own.
#ifndef SUN_MERGING
#define SUN_MERGING 0
#endif

// 1 where the device has cl_khr_int64_base_atomics; otherwise the film adds two 32-bit words with carry.
#ifndef SUN_ATOMICS_64
#define SUN_ATOMICS_64 0
#endif

// Explicit-vector kernels tell vectorizers to keep their hands off (Intel's runtime scalarizes them otherwise).
#if !defined(__cplusplus) && LANES > 1
#define SUN_KERNEL __kernel __attribute__((vec_type_hint(float16)))
#else
#define SUN_KERNEL __kernel
#endif

// What a kernel does, as a function that is called. PoCL gives the private arrays of a kernel to each work-item of a group anew (1.5 MB for shade at 64
// work-items, beyond the cache); those of a function that it calls stand on the stack, at the same place for all. Where vectors are explicit, that is
// on CPUs; elsewhere it is part of its kernel as ever.
#if defined(__cplusplus) || (LANES == 1 && SUN_LAYOUT == SUN_LAYOUT_BINARY)
#define SUN_BODY static inline
#else
#define SUN_BODY static __attribute__((noinline))
#endif

#endif
