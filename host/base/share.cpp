// SPDX-License-Identifier: Apache-2.0
#include "base/share.h"

#include "base/error.h"

namespace sunstone {

std::filesystem::path shared_file(const std::string &name) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const std::filesystem::path file = (program / ".." / SUNSTONE_DATADIR / "sunstone" / name).lexically_normal();
  if (!std::filesystem::exists(file, error)) throw Error(printable(file.string(), 400), "comes with the program and is not there", "install sunstone again: cmake --install");
  return file;
}

}  // namespace sunstone
