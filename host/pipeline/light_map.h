// SPDX-License-Identifier: Apache-2.0
// Light vertices of a whole light pass on the device, in the order of their paths, and grids over them (shared/light_map.h). Nothing of it depends on the pool.
#pragma once
#include "device/kernel.h"
#include "shared/frame.h"
#include "shared/light_map.h"

namespace sunstone {

struct Pool;

// Vertices by place: what kernels take as LIGHT_MAP_PARAMETERS, beside the vertices themselves.
struct LightGrid {
  Buffer<kernel::uint> entries, starts;
  kernel::uint mask = 0;
  float radius = 1;
  std::size_t bytes() const { return entries.bytes() + starts.bytes(); }
};

class LightMap {
 public:
  // `records`: how many of a vertex are kept, see SUN_LIGHT_VERTEX_RECORDS.
  LightMap(const Device &device, const Program &program, unsigned records);

  // Empties it, for a pass of so many paths.
  void begin(std::uint32_t paths);

  // Takes the vertices of paths [first, first + count), after all of which have ended. Throws Error where the device has no room for them.
  void collect(const Pool &pool, const Buffer<kernel::Frame> &frame, std::uint32_t first, std::uint32_t count);

  // After the last: path p's vertices are those from path_starts()[p] to path_starts()[p + 1].
  void end();

  // Of the vertices that have all flags of `wanted`.
  void build(LightGrid &grid, float radius, kernel::uint wanted);

  const Buffer<kernel::uint> &vertices() const { return vertices_; }
  const Buffer<kernel::uint> &path_starts() const { return path_starts_; }
  kernel::uint records() const { return records_; }
  std::uint32_t count() const { return count_; }
  std::size_t bytes() const;  // without the grids

 private:
  kernel::uint scan(const Buffer<kernel::uint> &values, kernel::uint at, kernel::uint count, kernel::uint base);
  void grow(std::uint32_t wanted);
  template <class T> void reserve(Buffer<T> &buffer, std::size_t size, const char *what) const;

  Device device_;
  kernel::uint records_;
  std::uint32_t paths_ = 0, count_ = 0;
  Buffer<kernel::uint> vertices_, path_starts_, path_slots_, sums_, histogram_, keys_[2], order_[2];
  Kernel tally_, collect_, copy_, keys_of_, histogram_of_, reorder_, entries_, table_, scan_blocks_, scan_sums_, scan_values_;
};

}  // namespace sunstone
