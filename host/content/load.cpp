// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include "base/error.h"
#include "content/content.h"

namespace sunstone {

static const Content &open_content() {
  constexpr const char *name = "libsunstone_content.so";
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  std::string tried;
  for (const std::filesystem::path &folder : {program / ".." / SUNSTONE_LIBDIR, program / ".." / "lib", program}) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::exists(file, error)) continue;
    void *object = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!object) throw Error(file.string(), dlerror(), "a library it needs is missing; on Debian run scripts/setup.sh");
    const auto entry = reinterpret_cast<ContentFunction>(dlsym(object, content_symbol));
    if (!entry) throw Error(file.string(), "is not sunstone's content object");
    const Content *content = entry(sizeof(Content));
    if (!content) throw Error(file.string(), "belongs to another build of sunstone", "install the program again");
    return *content;
  }
  throw Error(name, "was not found beside the program", "it is installed in the lib folder next to bin");
}

const Content &load_content() {
  static const Content &content = open_content();
  return content;
}

}  // namespace sunstone
