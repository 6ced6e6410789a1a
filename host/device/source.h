// SPDX-License-Identifier: Apache-2.0
// Kernel sources: every file under kernels/ is embedded by the build; each #include "..." is resolved once, and #line keeps file names in device errors.
#pragma once
#include <string>
#include <string_view>

namespace sunstone {

// The text of an embedded file ("stages/shade.cl"); throws Error where there is none.
std::string_view embedded_source(std::string_view name);

// `text` with its includes put in place (recursively, each once).
std::string resolve_includes(std::string_view text, const std::string &name);

}  // namespace sunstone
