// SPDX-License-Identifier: Apache-2.0
// Which samples a film holds: half-open ranges, sorted, disjoint and never adjacent, so that equal sets look equal.
#include <algorithm>

#include "base/error.h"
#include "film/film.h"

namespace sunstone {

static std::string show(SampleRange range) { return std::to_string(range.first) + ":" + std::to_string(range.last); }

void insert_samples(std::vector<SampleRange> &ranges, SampleRange range) {
  if (range.first > range.last) throw Error("samples " + show(range), "the range ends before it begins");
  if (range.first == range.last) return;
  const auto next = std::find_if(ranges.begin(), ranges.end(), [&](const SampleRange &r) { return r.last > range.first; });
  if (next != ranges.end() && next->first < range.last) {
    const SampleRange both{std::max(next->first, range.first), std::min(next->last, range.last)};
    throw Error("samples " + show(range), "samples " + show(both) + " are there already");
  }
  const bool joins_previous = next != ranges.begin() && std::prev(next)->last == range.first;
  const bool joins_next = next != ranges.end() && next->first == range.last;
  if (joins_previous && joins_next) {
    std::prev(next)->last = next->last;
    ranges.erase(next);
  } else if (joins_previous) {
    std::prev(next)->last = range.last;
  } else if (joins_next) {
    next->first = range.first;
  } else {
    ranges.insert(next, range);
  }
}

std::string show_samples(const std::vector<SampleRange> &ranges) {
  std::string text;
  for (const SampleRange &range : ranges) text += (text.empty() ? "" : ", ") + show(range);
  return text;
}

std::uint64_t Film::sample_count() const {
  std::uint64_t count = 0;
  for (const SampleRange &range : samples) count += range.last - range.first;
  return count;
}

}  // namespace sunstone
