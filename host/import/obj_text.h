// SPDX-License-Identifier: Apache-2.0
// Lines, words and numbers of OBJ and MTL files, read strictly, and faults counted by kind. Numbers do not depend on the locale.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/notice.h"

namespace sunstone {

// Logical lines of a text: they end in LF, CRLF or CR; a backslash at the end of one (not of a comment) goes on in the next. Blanks at both ends and
// whole-line comments are left out.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}
  bool next(std::string_view &line, std::size_t &number);  // `line` is valid until the next call

 private:
  std::string_view physical();
  std::string_view text_;
  std::size_t at_ = 0, number_ = 0;
  std::string joined_;
};

std::string_view trim(std::string_view text);
// Takes the first word off `text`.
std::string_view take_word(std::string_view &text);
// `text` up to a '#' that follows a blank.
std::string_view without_comment(std::string_view text);
// The whole word as a finite number, "+1" and "1." too; nothing for "nan", "0x10", "1.#IND", "1e400".
std::optional<float> parse_number(std::string_view word);
std::optional<std::int64_t> parse_integer(std::string_view word);

// Throws Error{place, ...} for UTF-16 and UTF-32 text; steps over UTF-8's mark.
std::string_view checked_text(std::string_view text, const std::string &place);

// Windows' separators turned into ours, and quotes taken off.
std::string portable_name(std::string_view name);
// "C:...", which is no path here.
bool names_drive(std::string_view name);

// Faults of one file by kind: a warning each, that names the first line and how many more there are.
class LineFaults {
 public:
  explicit LineFaults(std::string file) : file_(std::move(file)) {}
  void add(const std::string &what, std::size_t line) {
    Entry &entry = entries_[what];
    if (entry.count++ == 0) entry.line = line;
  }
  void report(Notices &notices) const;
  const std::string &file() const { return file_; }

 private:
  struct Entry {
    std::size_t count = 0, line = 0;
  };
  std::string file_;
  std::map<std::string, Entry> entries_;
};

}  // namespace sunstone
