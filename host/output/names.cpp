// SPDX-License-Identifier: Apache-2.0
// Which suffixes are written, asked before a render begins.
#include <algorithm>

#include "base/error.h"
#include "output/output.h"
#include "output/suffix.h"

namespace sunstone {

std::string suffix_of(const std::filesystem::path &path) {
  std::string suffix = path.extension().string();
  for (char &c : suffix)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return suffix;
}

const std::vector<std::string> &picture_suffixes() {
  static const std::vector<std::string> suffixes = {".exr", ".png", ".jpg", ".jpeg", ".hdr", ".tif", ".tiff", ".film"};
  return suffixes;
}

void check_picture_name(const std::filesystem::path &path) {
  const std::string suffix = suffix_of(path);
  const std::vector<std::string> &known = picture_suffixes();
  if (std::find(known.begin(), known.end(), suffix) != known.end()) return;
  std::string list;
  for (const std::string &name : known) list += (list.empty() ? "" : " ") + name;
  throw UsageError(printable(path.string(), 400),
                   suffix.empty() ? "has no suffix to tell the format by" : "the suffix " + printable(suffix) + " is not known",
                   "pictures are written as " + list);
}

}  // namespace sunstone
