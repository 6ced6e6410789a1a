// SPDX-License-Identifier: Apache-2.0
// Look-ups in a map of light vertices: a grid of cells twice the radius wide, hashed to buckets [Teschner03], so that a sphere of that radius meets eight cells. They are
// visited in a fixed order, and a vertex is found in its own cell alone, by its place: so what is found, and in which order, depends neither on the size of the table nor
// on collisions in it. Within a cell vertices stand in the order of their paths.
#ifndef SUN_TRANSPORT_LIGHT_MAP_H
#define SUN_TRANSPORT_LIGHT_MAP_H
#include "math/hash.h"
#include "math/vector.h"
#include "shared/light_map.h"

SUN_NAMESPACE_BEGIN

typedef struct LightMap {
  const SUN_GLOBAL uint *vertices;  // `records` of 16 words each
  const SUN_GLOBAL uint *entries;   // SUN_MAP_ENTRY_WORDS each, by bucket
  const SUN_GLOBAL uint *starts;    // where each bucket begins among them, and where the last ends
  uint records, mask;               // buckets, less 1
  float radius;
} LightMap;

#define LIGHT_MAP_PARAMETERS const SUN_GLOBAL uint *map_vertices, const SUN_GLOBAL uint *map_entries, const SUN_GLOBAL uint *map_starts, uint map_records, uint map_mask, float map_radius
#define LIGHT_MAP_ARGUMENTS map_vertices, map_entries, map_starts, map_records, map_mask, map_radius

SUN_FN LightMap open_light_map(LIGHT_MAP_PARAMETERS) {
  LightMap map;
  map.vertices = map_vertices;
  map.entries = map_entries;
  map.starts = map_starts;
  map.records = map_records;
  map.mask = map_mask;
  map.radius = map_radius;
  return map;
}

// Cells along one axis; those beyond what an int holds are one. Scalar code: a lane at a time.
SUN_FN int map_cell(float place, float radius) {
  float cell = floor(place / (2.0f * radius));
  cell = cell > -1.0e9f ? cell : -1.0e9f;
  return (int)(cell < 1.0e9f ? cell : 1.0e9f);
}
SUN_FN uint map_bucket(const int *cell, uint mask) { return hash3_1((uint)cell[0], (uint)cell[1], (uint)cell[2]) & mask; }

// One look-up on its way through the cells.
typedef struct MapQuery {
  float place[3], normal[3];  // and the normal of the front
  uint solid;                 // the surface bounds a solid: what lies on the other side of it is another surface
  int first[3], cell[3];      // the least of its cells; the one at hand
  uint visited;               // cells begun: 9 where there is nothing to look for
  uint at, end;               // entries of its bucket
} MapQuery;

// The next vertex within the radius, on a surface that faces about the same way and does not lie beside this one; SUN_NONE after the last.
SUN_FN uint map_next_1(const LightMap *map, MapQuery *q) {
  for (;;) {
    while (q->at < q->end) {
      const SUN_GLOBAL uint *entry = map->entries + (size_t)q->at * SUN_MAP_ENTRY_WORDS;
      q->at++;
      float x[3], distance2 = 0.0f, facing = 0.0f, here = 0.0f, there = 0.0f;
      SUN_UNROLL
      for (int axis = 0; axis < 3; axis++) {
        x[axis] = as_float(entry[axis]);
        float to = x[axis] - q->place[axis];
        distance2 += to * to;
      }
      if (!(distance2 < map->radius * map->radius)) continue;
      uint vertex = entry[3];
      const SUN_GLOBAL uint *word = map->vertices + (size_t)vertex * map->records * 16;
      SUN_UNROLL
      for (int axis = 0; axis < 3; axis++) {
        float normal = as_float(word[SUN_LIGHT_VERTEX_NORMAL + axis]), to = x[axis] - q->place[axis];
        facing += normal * q->normal[axis];
        here += to * q->normal[axis];
        there += to * normal;
      }
      // How far the one lies off the plane of the other, either way, or both off one between them: on a sphere the last is 0, across an edge one of the others.
      float between = 0.5f * (here + (facing < 0.0f ? -there : there));
      float off = fabs(here) < fabs(there) ? fabs(here) : fabs(there);
      off = fabs(between) < off ? fabs(between) : off;
      if (!(off < SUN_MERGE_OFF * map->radius)) continue;
      uint flags = word[SUN_LIGHT_VERTEX_FLAGS];
      // Its normal stands on the side from which it was found.
      facing = (flags & SUN_LIGHT_VERTEX_FRONT) ? facing : -facing;
      facing = q->solid | (flags & SUN_LIGHT_VERTEX_SOLID) ? facing : fabs(facing);
      if (!(facing > SUN_MERGE_COSINE)) continue;
      uint same = 1;
      SUN_UNROLL
      for (int axis = 0; axis < 3; axis++) same = same & (map_cell(x[axis], map->radius) == q->cell[axis] ? 1u : 0u);
      if (same) return vertex;
    }
    if (q->visited >= 8) return SUN_NONE;
    for (uint axis = 0; axis < 3; axis++) q->cell[axis] = q->first[axis] + (int)((q->visited >> axis) & 1u);
    q->visited++;
    uint bucket = map_bucket(q->cell, map->mask);
    q->at = map->starts[bucket];
    q->end = map->starts[bucket + 1];
  }
}

// Look-ups of LANES surfaces, each as fast as it goes.
typedef struct MapQueries {
  MapQuery lane[LANES];
} MapQueries;

SUN_FN void map_begin(const LightMap *map, MapQueries *queries, vec3 position, vec3 front_normal, mask solid, mask active) {
  float x[3][LANES], n[3][LANES];
  int solids[LANES], on[LANES];
  LANES_STORE(position.x, x[0]);
  LANES_STORE(position.y, x[1]);
  LANES_STORE(position.z, x[2]);
  LANES_STORE(front_normal.x, n[0]);
  LANES_STORE(front_normal.y, n[1]);
  LANES_STORE(front_normal.z, n[2]);
  LANES_STORE(solid, solids);
  LANES_STORE(active, on);
  for (int lane = 0; lane < LANES; lane++) {
    MapQuery *q = &queries->lane[lane];
    SUN_UNROLL
    for (int axis = 0; axis < 3; axis++) {
      q->place[axis] = x[axis][lane];
      q->normal[axis] = n[axis][lane];
      q->first[axis] = on[lane] ? map_cell(x[axis][lane] - map->radius, map->radius) : 0;
      q->cell[axis] = 0;
    }
    q->solid = solids[lane] ? 1u : 0u;
    q->visited = on[lane] ? 0u : 8u;
    q->at = q->end = 0;
  }
}

// The next vertex of each lane that has one more: where the answer is true. Others name vertex 0.
SUN_FN mask map_next(const LightMap *map, MapQueries *queries, uint_n *vertex) {
  uint found[LANES];
  for (int lane = 0; lane < LANES; lane++) found[lane] = map_next_1(map, &queries->lane[lane]);
  uint_n all = LANES_LOAD(found);
  mask some = all != (uint_n)(SUN_NONE);
  *vertex = some ? all : (uint_n)(0);
  return some;
}

SUN_NAMESPACE_END
#endif
