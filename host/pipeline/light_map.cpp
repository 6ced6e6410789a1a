// SPDX-License-Identifier: Apache-2.0
#include "pipeline/light_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "pipeline/stages.h"
#include "shared/bidirectional.h"

namespace sunstone {

namespace {

constexpr std::uint32_t most_records = 1u << 28;  // of 16 words: kernels count words in 32 bits
constexpr kernel::uint chunk = 1024;              // entries that a work-item of the sort owns

kernel::uint blocks_of(kernel::uint count) { return (count + SUN_SCAN_BLOCK - 1) / SUN_SCAN_BLOCK; }

}  // namespace

LightMap::LightMap(const Device &device, const Program &program, unsigned records)
    : device_(device),
      records_(records),
      tally_(program, "tally"),
      collect_(program, "collect"),
      copy_(program, "copy_words"),
      keys_of_(program, "map_keys"),
      histogram_of_(program, "histogram_chunks"),
      reorder_(program, "reorder_chunks"),
      entries_(program, "map_entries"),
      table_(program, "map_table"),
      scan_blocks_(program, "scan_blocks"),
      scan_sums_(program, "scan_sums"),
      scan_values_(program, "scan_values") {}

// At least so large; what it held is lost where it has to be another one.
template <class T> void LightMap::reserve(Buffer<T> &buffer, std::size_t size, const char *what) const {
  if (buffer && buffer.size() >= size) return;
  buffer = {};
  buffer = Buffer<T>(device_, size, what);
}

void LightMap::begin(std::uint32_t paths) {
  paths_ = paths;
  count_ = 0;
  reserve(path_starts_, static_cast<std::size_t>(paths) + 1, "light paths");
  path_starts_.fill_zero();
  grow(std::max(paths, 1024u));
}

// Room for `wanted` vertices; those that are there stay.
void LightMap::grow(std::uint32_t wanted) {
  const std::size_t words = std::size_t(16) * records_, most = std::min<std::size_t>(device_.info().max_allocation / (words * sizeof(kernel::uint)), most_records / records_);
  const auto refuse = [&](const std::string &why) {
    throw Error("light map", fmt::format("{} light paths left {} vertices, {:.0f} MiB: {}", paths_, wanted, static_cast<double>(wanted * words) * 4 / 1048576, why),
                "use fewer --photons, a smaller --size, or another --device");
  };
  if (wanted > most) refuse(fmt::format("the device allows {} in one piece", most));
  if (vertices_ && vertices_.size() >= wanted * words) return;
  const std::size_t room = std::min<std::size_t>(most, std::max<std::size_t>(wanted, vertices_.size() / words * 2));
  if (device_.allocated() + room * words * sizeof(kernel::uint) > device_.info().memory) refuse("the device has no room for them");
  Buffer<kernel::uint> larger(device_, room * words, "light map");
  const kernel::uint kept = static_cast<kernel::uint>(count_ * words);
  if (kept) copy_.run(kept, vertices_, larger, kept);
  else larger.fill_zero();  // lanes without a vertex read the first
  vertices_ = larger;
}

// Returns `base` and the sum of all.
kernel::uint LightMap::scan(const Buffer<kernel::uint> &values, kernel::uint at, kernel::uint count, kernel::uint base) {
  const kernel::uint blocks = blocks_of(count);
  reserve(sums_, blocks + 1, "sums");
  scan_blocks_.run(blocks, values, at, count, sums_);
  scan_sums_.run(1, count, base, sums_);
  scan_values_.run(blocks, values, at, count, sums_);
  return blocks;
}

void LightMap::collect(const Pool &pool, const Buffer<kernel::Frame> &frame, std::uint32_t first, std::uint32_t count) {
  reserve(path_slots_, count, "slots of light paths");
  tally_.run(pool.slots, frame, pool.walks, path_starts_, path_slots_, first, count);
  const kernel::uint blocks = scan(path_starts_, first, count, count_);
  const std::uint32_t end = sums_.download(blocks, 1)[0];
  grow(end);
  if (end > count_) collect_.run(count, frame, pool.light_vertices, path_starts_, path_slots_, vertices_, first, count, end, records_);
  count_ = end;
}

void LightMap::end() { path_starts_.upload(std::span(&count_, 1), paths_); }

void LightMap::build(LightGrid &grid, float radius, kernel::uint wanted) {
  // About as many buckets as vertices; one more key for what is not wanted.
  const unsigned bits = std::max(8, static_cast<int>(std::bit_width(std::max(count_, 1u) - 1)));
  grid.mask = (1u << bits) - 1;
  grid.radius = radius;
  reserve(grid.starts, (std::size_t(1) << bits) + 1, "table of the light map");
  reserve(grid.entries, static_cast<std::size_t>(count_) * SUN_MAP_ENTRY_WORDS, "entries of the light map");
  for (auto &order : order_) reserve(order, count_, "order of the light map");
  for (auto &keys : keys_) reserve(keys, count_, "keys of the light map");
  const kernel::uint chunks = (count_ + chunk - 1) / chunk;
  reserve(histogram_, static_cast<std::size_t>(chunks) * SUN_SORT_DIGITS, "histogram");
  const unsigned passes = (bits + 1 + SUN_SORT_BITS - 1) / SUN_SORT_BITS;
  unsigned now = 0;
  keys_of_.run(count_, vertices_, records_, count_, radius, grid.mask, wanted, keys_[now], order_[now]);
  for (unsigned pass = 0; pass < passes && count_ > 0; pass++, now = 1 - now) {
    const kernel::uint shift = pass * SUN_SORT_BITS;
    histogram_of_.run(chunks, keys_[now], count_, chunk, shift, histogram_);
    scan(histogram_, 0, chunks * SUN_SORT_DIGITS, 0);
    reorder_.run(chunks, keys_[now], order_[now], count_, chunk, shift, histogram_, keys_[1 - now], order_[1 - now]);
  }
  entries_.run(count_, vertices_, records_, count_, order_[now], grid.entries);
  table_.run(static_cast<std::size_t>(count_) + 1, keys_[now], count_, grid.mask, grid.starts);
}

std::size_t LightMap::bytes() const {
  return vertices_.bytes() + path_starts_.bytes() + path_slots_.bytes() + sums_.bytes() + histogram_.bytes() + keys_[0].bytes() + keys_[1].bytes() + order_[0].bytes() + order_[1].bytes();
}

}  // namespace sunstone
