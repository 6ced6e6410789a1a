// SPDX-License-Identifier: Apache-2.0
// --exposure and --tone.
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "cli/commands.h"

namespace sunstone {

void add_view_options(CLI::App &command, ViewOptions &view) {
  command
      .add_option_function<std::string>(
          "--exposure",
          [&view](const std::string &text) {
            if (text == "auto") {
              view.exposure.reset();
              return;
            }
            const std::optional<float> ev = read_number<float>(std::string_view(text).substr(text.starts_with('+') ? 1 : 0));
            if (!ev || !(std::fabs(*ev) <= 64))
              throw CLI::ValidationError("--exposure", printable(text) + " is neither \"auto\" nor a number of stops from -64 to 64");
            view.exposure = ev;
          },
          "Brighten views by so many stops; auto: the mean becomes middle grey [0]")
      ->type_name("EV|auto");
  command
      .add_option_function<std::string>(
          "--tone", [&view](const std::string &text) { view.tone = text == "filmic" ? Tone::filmic : Tone::none; },
          "The curve of views: none clips at 1, filmic rolls off the highlights [none]")
      ->check(CLI::IsMember({"none", "filmic"}))
      ->type_name("NAME");
}

}  // namespace sunstone
