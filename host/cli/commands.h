// SPDX-License-Identifier: Apache-2.0
// The commands, each registered by one function with its help and examples; its callback does the work, and throws Error where it fails.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "base/notice.h"
#include "import/import.h"
#include "output/output.h"

namespace sunstone {

struct CommandContext {
  Notices notices;
  bool quiet = false;   // -q: warnings, but no notes
  int exit_status = 0;  // of work that was done, with an answer that is no success: pictures that differ
};

void add_render(CLI::App &app, CommandContext &context);
void add_devices(CLI::App &app, CommandContext &context);
void add_verify(CLI::App &app, CommandContext &context);
void add_info(CLI::App &app, CommandContext &context);
void add_bench(CLI::App &app, CommandContext &context);
void add_learn(CLI::App &app, CommandContext &context);
void add_cache(CLI::App &app, CommandContext &context);
void add_compare(CLI::App &app, CommandContext &context);
void add_merge(CLI::App &app, CommandContext &context);
void add_completion(CLI::App &app, CommandContext &context);

// --exposure and --tone, for every command that writes views. `view` must outlive the parse.
void add_view_options(CLI::App &command, ViewOptions &view);

// --time-at and --animation, for every command that opens scenes; then what one means without the other. `options` must outlive the parse.
void add_pose_options(CLI::App &command, ImportOptions &options);
void check_pose_options(const ImportOptions &options);

// A script for bash, zsh or fish that completes all commands and options of `app`, however many there are when it is called.
std::string completion_script(const CLI::App &app, const std::string &shell);

}  // namespace sunstone
