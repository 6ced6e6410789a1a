// SPDX-License-Identifier: Apache-2.0
// Where instances stand at the scene's moment, and what their matrices make of points, directions and normals.
#ifndef SUN_SCENE_PLACEMENT_H
#define SUN_SCENE_PLACEMENT_H
#include "scene/scene.h"
#include "scene/shape_surface.h"

SUN_NAMESPACE_BEGIN

SUN_INLINE void matrix_row(Matrix *matrix, int row, Quad quad) {
  matrix->m[4 * row] = real_of_bits(quad.x);
  matrix->m[4 * row + 1] = real_of_bits(quad.y);
  matrix->m[4 * row + 2] = real_of_bits(quad.z);
  matrix->m[4 * row + 3] = real_of_bits(quad.w);
}

// `flags`: of the instance.
SUN_FN Matrix instance_to_world(const Scene *scene, uint_n instance, uint_n flags) {
  Matrix matrix;
  SUN_UNROLL
  for (int row = 0; row < 3; row++) {
    Quad quad;
    SCENE_QUAD(quad, scene, instances, instance, to_world[4 * row]);
    matrix_row(&matrix, row, quad);
  }
  mask moving = (flags & (uint_n)(SUN_INSTANCE_MOVING)) != (uint_n)(0);
  if (SUN_MOTION && ANY(moving)) {
    const SUN_GLOBAL InstanceKey *keys = (const SUN_GLOBAL InstanceKey *)(scene->motion + 1);
    uint_n key = (flags >> (uint_n)(SUN_INSTANCE_MOTION_SHIFT)) * (uint_n)(scene->frame->motion_steps + 1u) + scene->moment.step;
    key = moving ? key : (uint_n)(0);
    Matrix before, after;
    SUN_UNROLL
    for (int row = 0; row < 3; row++) {
      Quad quad;
      GATHER_QUAD(quad, keys, key, to_world[4 * row]);
      matrix_row(&before, row, quad);
      GATHER_QUAD(quad, keys, key + (uint_n)(1), to_world[4 * row]);
      matrix_row(&after, row, quad);
    }
    SUN_UNROLL
    for (int k = 0; k < 12; k++) matrix.m[k] = moving ? blend_real(before.m[k], after.m[k], scene->moment.blend) : matrix.m[k];
  }
  return matrix;
}

// Areas and normals go by the cofactors: the inverse, transposed, times the determinant.
SUN_FN real matrix_cofactor(const Matrix *matrix, int row, int column) {
  const real *m = matrix->m;
  int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
  return m[4 * r1 + c1] * m[4 * r2 + c2] - m[4 * r1 + c2] * m[4 * r2 + c1];
}
SUN_FN mask matrix_mirrors(const Matrix *matrix) {
  const real *m = matrix->m;
  return m[0] * matrix_cofactor(matrix, 0, 0) + m[1] * matrix_cofactor(matrix, 0, 1) + m[2] * matrix_cofactor(matrix, 0, 2) < 0.0f;
}

// The inverse; of an instance that moves its linear part alone, but for a positive factor.
SUN_FN Matrix instance_to_object(const Scene *scene, uint_n instance, uint_n flags) {
  Matrix matrix;
  SUN_UNROLL
  for (int row = 0; row < 3; row++) {
    Quad quad;
    SCENE_QUAD(quad, scene, instances, instance, to_object[4 * row]);
    matrix_row(&matrix, row, quad);
  }
  mask moving = (flags & (uint_n)(SUN_INSTANCE_MOVING)) != (uint_n)(0);
  if (SUN_MOTION && ANY(moving)) {
    Matrix to_world = instance_to_world(scene, instance, flags);
    mask mirrored = matrix_mirrors(&to_world);
    SUN_UNROLL
    for (int row = 0; row < 3; row++)
      SUN_UNROLL
      for (int column = 0; column < 3; column++) {
        real cofactor = matrix_cofactor(&to_world, column, row);
        matrix.m[4 * row + column] = moving ? (mirrored ? -cofactor : cofactor) : matrix.m[4 * row + column];
      }
  }
  return matrix;
}

SUN_FN vec3 transform_point(const Matrix *matrix, vec3 p) {
  const real *m = matrix->m;
  return make_vec3(m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7], m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]);
}
// Directions along the surface go by the matrix, normals by its inverse transposed, so that a mirrored front stays the front.
SUN_FN vec3 transform_direction(const Matrix *matrix, vec3 d) {
  const real *m = matrix->m;
  return make_vec3(m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z, m[8] * d.x + m[9] * d.y + m[10] * d.z);
}
SUN_FN vec3 transform_normal(const Matrix *to_object, vec3 n) {
  const real *m = to_object->m;
  return make_vec3(m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z, m[2] * n.x + m[6] * n.y + m[10] * n.z);
}

SUN_NAMESPACE_END
#endif
