// SPDX-License-Identifier: Apache-2.0
// Warnings and notes on the way to a picture, passed as an argument and never kept in a global.
#pragma once
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace sunstone {

struct Notice {
  enum class Kind { warning, note } kind;
  std::string place, text;
};

// Collects notices, each distinct one once, and shows it at once where a sink is given. Safe from several threads.
class Notices {
 public:
  explicit Notices(std::function<void(const Notice &)> sink = {}) : sink_(std::move(sink)) {}
  void warning(std::string place, std::string text) { add({Notice::Kind::warning, std::move(place), std::move(text)}); }
  void note(std::string place, std::string text) { add({Notice::Kind::note, std::move(place), std::move(text)}); }
  const std::vector<Notice> &all() const { return all_; }

 private:
  void add(Notice notice);
  std::function<void(const Notice &)> sink_;
  std::vector<Notice> all_;
  std::mutex mutex_;
};

}  // namespace sunstone
