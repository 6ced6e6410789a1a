// SPDX-License-Identifier: Apache-2.0
// The columns of a path, once: kernels make accessors of the list, the host its sizes. Include with PATH_FIELD(type, name) defined.
// A path's fields stand together in one record of 64 bytes on CPUs (one cache line), in columns on GPUs: path/path.h knows.
PATH_FIELD(float, origin_x)         // of the ray being traced, world space; the last scattering vertex, offset
PATH_FIELD(float, origin_y)
PATH_FIELD(float, origin_z)
PATH_FIELD(float, direction_x)      // unit length
PATH_FIELD(float, direction_y)
PATH_FIELD(float, direction_z)
PATH_FIELD(float, passed_t)         // hits count strictly after (passed_t, passed_instance, passed_primitive): 0, SUN_NONE, SUN_NONE for a new ray
PATH_FIELD(uint, passed_instance)
PATH_FIELD(uint, passed_primitive)
PATH_FIELD(float, throughput_r)
PATH_FIELD(float, throughput_g)
PATH_FIELD(float, throughput_b)
PATH_FIELD(float, pdf_solid_angle)  // of the ray being traced; 0: a delta direction (camera, mirror, smooth glass)
PATH_FIELD(uint, pixel)             // within the tile, row major
PATH_FIELD(uint, sample)            // absolute sample index
PATH_FIELD(uint, vertex)            // hits so far, null events counted: keys what random numbers the next hit takes
