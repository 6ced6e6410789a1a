// SPDX-License-Identifier: Apache-2.0
#include "base/notice.h"

namespace sunstone {

void Notices::add(Notice notice) {
  const std::lock_guard lock(mutex_);
  for (const Notice &earlier : all_)
    if (earlier.kind == notice.kind && earlier.place == notice.place && earlier.text == notice.text) return;
  all_.push_back(notice);
  if (sink_) sink_(all_.back());
}

}  // namespace sunstone
