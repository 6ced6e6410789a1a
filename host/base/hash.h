// SPDX-License-Identifier: Apache-2.0
// 128-bit hashes (XXH3) of bytes, shown as 32 hex digits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace sunstone {

struct Hash {
  std::uint64_t high = 0, low = 0;
  bool operator==(const Hash &) const = default;
  std::string hex() const;
};

// Hashes a row of things one after the other; spans are preceded by their length, so ("ab", "c") and ("a", "bc") differ.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher &) = delete;
  Hasher &operator=(const Hasher &) = delete;
  void bytes(const void *data, std::size_t size);
  void add(std::string_view text) { span(std::span(text.data(), text.size())); }
  template <class T> void value(const T &v) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
    bytes(&v, sizeof v);
  }
  template <class T> void span(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(static_cast<std::uint64_t>(values.size()));
    bytes(values.data(), values.size_bytes());
  }
  Hash digest() const;

 private:
  void *state_;
};

}  // namespace sunstone
