// SPDX-License-Identifier: Apache-2.0
// The table that kernels/embed.cmake makes.
#pragma once
#include <span>
#include <string_view>

namespace sunstone {

struct EmbeddedFile {
  std::string_view name, text;
};
std::span<const EmbeddedFile> embedded_files();

}  // namespace sunstone
