// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <cstdio>

namespace sunstone {

static std::string join(const std::string &place, const std::string &reason, const std::string &hint) {
  std::string text = place.empty() ? reason : place + ": " + reason;
  if (!hint.empty()) text += " (" + hint + ")";
  return text;
}

Error::Error(std::string place_, std::string reason_, std::string hint_)
    : std::runtime_error(join(place_, reason_, hint_)), place(std::move(place_)), reason(std::move(reason_)), hint(std::move(hint_)) {}

// Length of the valid UTF-8 sequence at `i`, or 0.
static std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(i);
  const std::size_t length = lead < 0x80 ? 1 : lead >= 0xc2 && lead < 0xe0 ? 2 : (lead & 0xf0) == 0xe0 ? 3 : lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; k++)
    if ((byte(i + k) & 0xc0) != 0x80) return 0;
  if (lead == 0xe0 && byte(i + 1) < 0xa0) return 0;   // overlong
  if (lead == 0xed && byte(i + 1) >= 0xa0) return 0;  // surrogates
  if (lead == 0xf0 && byte(i + 1) < 0x90) return 0;
  if (lead == 0xf4 && byte(i + 1) >= 0x90) return 0;
  if (lead == 0xc2 && byte(i + 1) < 0xa0) return 0;   // C1 controls
  return length;
}

std::string printable(std::string_view text, std::size_t limit) {
  std::string out;
  std::size_t i = 0;
  while (i < text.size()) {
    if (out.size() >= limit) return out + "...";
    const std::size_t length = utf8_length(text, i);
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (length == 0 || c < 0x20 || c == 0x7f) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", c);
      out += escaped;
      i++;
    } else {
      out += text.substr(i, length);
      i += length;
    }
  }
  return out;
}

}  // namespace sunstone
