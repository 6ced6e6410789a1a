// SPDX-License-Identifier: Apache-2.0
#include "import/obj_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace sunstone {

namespace {
bool blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }
}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_word(std::string_view &text) {
  std::size_t begin = 0;
  while (begin < text.size() && blank(text[begin])) begin++;
  std::size_t end = begin;
  while (end < text.size() && !blank(text[end])) end++;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::string_view without_comment(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); i++)
    if (text[i] == '#' && blank(text[i - 1])) return trim(text.substr(0, i));
  return text;
}

std::string_view LineReader::physical() {
  std::size_t end = at_;
  while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r') end++;
  const std::string_view line = text_.substr(at_, end - at_);
  if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') end++;
  at_ = std::min(end + 1, text_.size());
  number_++;
  return trim(line);
}

bool LineReader::next(std::string_view &line, std::size_t &number) {
  while (at_ < text_.size()) {
    line = physical();
    number = number_;
    if (line.empty() || line.front() == '#') continue;
    if (line.back() != '\\') return true;
    joined_ = line;
    while (!joined_.empty() && joined_.back() == '\\' && at_ < text_.size()) {
      joined_.back() = ' ';
      joined_ += physical();
    }
    line = trim(joined_);
    if (!line.empty()) return true;
  }
  return false;
}

std::optional<float> parse_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-')) return std::nullopt;
  }
  double value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ptr != word.data() + word.size() || word.empty()) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range && word.find("e-") == std::string_view::npos && word.find("E-") == std::string_view::npos)
    return std::nullopt;
  if (result.ec == std::errc::invalid_argument || !(std::abs(value) <= 3.4028234e38)) return std::nullopt;
  return static_cast<float>(value);
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  std::int64_t value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec != std::errc() || result.ptr != word.data() + word.size()) return std::nullopt;
  return value;
}

std::string_view checked_text(std::string_view text, const std::string &place) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv) || text.starts_with("\0\0\xfe\xff"sv))
    throw Error(place, "is UTF-16 or UTF-32 text", "save it as UTF-8 or ASCII");
  if (text.starts_with("\xef\xbb\xbf"sv)) text.remove_prefix(3);
  return text;
}

std::string portable_name(std::string_view name) {
  name = trim(name);
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  std::string out(name);
  std::replace(out.begin(), out.end(), '\\', '/');
  return out;
}

bool names_drive(std::string_view name) {
  return name.size() >= 2 && name[1] == ':' && ((name[0] >= 'A' && name[0] <= 'Z') || (name[0] >= 'a' && name[0] <= 'z'));
}

void LineFaults::report(Notices &notices) const {
  for (const auto &[what, entry] : entries_)
    notices.warning(file_ + ":" + std::to_string(entry.line), what + (entry.count > 1 ? " (and " + std::to_string(entry.count - 1) + " more)" : ""));
}

}  // namespace sunstone
