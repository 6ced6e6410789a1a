// SPDX-License-Identifier: Apache-2.0
// --time-at, --shutter and --animation: what an animated scene looks like then.
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "cli/commands.h"

namespace sunstone {

void add_pose_options(CLI::App &command, ImportOptions &options) {
  command
      .add_option_function<std::string>(
          "--time-at",
          [&options](const std::string &text) {
            const std::optional<double> seconds = read_number<double>(text);
            if (!seconds || !(std::fabs(*seconds) <= 1e9))
              throw CLI::ValidationError("--time-at", printable(text) + " is no time in seconds, at most 1e9");
            options.time = seconds;
          },
          "Show the animation at this time [what is stored, at rest]")
      ->type_name("SECONDS")
      ->group("Motion");
  command
      .add_option_function<std::string>(
          "--shutter",
          [&options](const std::string &text) {
            const std::optional<double> seconds = read_number<double>(text);
            if (!seconds || !(*seconds >= 0 && *seconds <= 1e9)) throw CLI::ValidationError("--shutter", printable(text) + " is no time in seconds, from 0 to 1e9");
            options.shutter = *seconds;
          },
          "Keep the shutter open so long from that time on: what moves is blurred [0]")
      ->type_name("SECONDS")
      ->group("Motion");
  command.add_option("--animation", options.animation, "The file's animation of this name or number [0]")->type_name("NAME|INDEX")->group("Motion");
}

void check_pose_options(const ImportOptions &options) {
  if (!options.animation.empty() && !options.time)
    throw UsageError("--animation " + printable(options.animation), "is shown at a time, which is not given", "--time-at SECONDS gives it");
  if (options.shutter > 0 && !options.time) throw UsageError("--shutter", "opens at a time, which is not given", "--time-at SECONDS gives it");
}

}  // namespace sunstone
