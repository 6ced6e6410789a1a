// SPDX-License-Identifier: Apache-2.0
// sunstone cache clear: what can be made again is removed.
#include <fmt/format.h>

#include "base/cache.h"
#include "base/error.h"
#include "cli/commands.h"

namespace sunstone {

void add_cache(CLI::App &app, CommandContext &) {
  CLI::App *command = app.add_subcommand("cache", "Compiled programs and self-test verdicts that are kept");
  command->require_subcommand(1);
  CLI::App *clear = command->add_subcommand("clear", "Remove them; the next run compiles again");
  clear->callback([] {
    const std::size_t bytes = cache_clear();
    fmt::print("{}: {:.1f} MiB removed\n", printable(cache_folder().string(), 400), static_cast<double>(bytes) / 1048576.0);
  });
  clear->footer("PoCL keeps a cache of its own (POCL_CACHE_DIR), which is left alone.");
}

}  // namespace sunstone
