// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <charconv>
#include <optional>
#include <string_view>

namespace sunstone {

// The number that the whole text is, or nothing. By std::from_chars, so that no locale has a say.
template <class T> std::optional<T> read_number(std::string_view text) {
  T value{};
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size()) return {};
  return value;
}

}  // namespace sunstone
