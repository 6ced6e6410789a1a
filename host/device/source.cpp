// SPDX-License-Identifier: Apache-2.0
#include "device/source.h"

#include <set>

#include "base/error.h"
#include "device/embedded.h"

namespace sunstone {

std::string_view embedded_source(std::string_view name) {
  for (const EmbeddedFile &file : embedded_files())
    if (file.name == name) return file.text;
  throw Error(std::string(name), "no such kernel file in this program");
}

static void append(std::string &out, std::string_view text, const std::string &name, std::set<std::string, std::less<>> &seen) {
  out += "#line 1 \"" + name + "\"\n";
  int line = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    line++;
    constexpr std::string_view directive = "#include \"";
    if (!row.starts_with(directive)) {
      out += row;
      out += '\n';
      continue;
    }
    const std::size_t close = row.find('"', directive.size());
    if (close == std::string_view::npos) throw Error(name + ":" + std::to_string(line), "#include without a closing quote");
    const std::string included(row.substr(directive.size(), close - directive.size()));
    // A list of fields is included again and again on purpose; everything else once.
    if (included.ends_with("_fields.h") || seen.insert(included).second) append(out, embedded_source(included), included, seen);
    out += "#line " + std::to_string(line + 1) + " \"" + name + "\"\n";
  }
}

std::string resolve_includes(std::string_view text, const std::string &name) {
  std::string out;
  std::set<std::string, std::less<>> seen{name};
  append(out, text, name, seen);
  return out;
}

}  // namespace sunstone
