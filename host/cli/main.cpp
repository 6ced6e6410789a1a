// SPDX-License-Identifier: Apache-2.0
// sunstone: the command. The one place where errors become exit statuses: 0 done, 1 the work failed, 2 wrong usage.
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "base/error.h"
#include "cli/commands.h"

namespace {

void show(const char *kind, const std::string &text) { std::fprintf(stderr, "sunstone: %s: %s\n", kind, text.c_str()); }

void show_notice(const sunstone::Notice &notice, bool quiet) {
  if (quiet && notice.kind == sunstone::Notice::Kind::note) return;
  const std::string text = notice.place.empty() ? notice.text : notice.place + ": " + notice.text;
  show(notice.kind == sunstone::Notice::Kind::warning ? "warning" : "note", text);
}

}  // namespace

int main(int argc, char **argv) {
  using namespace sunstone;
  CLI::App app{"sunstone renders glTF and OBJ scenes by path tracing, on any OpenCL device, the same bits everywhere.", "sunstone"};
  app.set_version_flag("--version", "sunstone " SUNSTONE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(38);
  app.footer("Example: sunstone render scenes/cornell/cornell.gltf --size 512x512 -o cornell.png");
  CommandContext context{Notices([&context](const Notice &notice) { show_notice(notice, context.quiet); })};
  add_render(app, context);
  add_devices(app, context);
  add_verify(app, context);
  add_info(app, context);
  add_compare(app, context);
  add_merge(app, context);
  add_bench(app, context);
  add_learn(app, context);
  add_cache(app, context);
  add_completion(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success &e) {
    return app.exit(e);
  } catch (const CLI::ParseError &e) {
    show("error", std::string(e.what()) + " (sunstone --help, and sunstone COMMAND --help, tell the flags)");
    return 2;
  } catch (const UsageError &e) {
    show("error", e.what());
    return 2;
  } catch (const Error &e) {
    show("error", e.what());
    return 1;
  } catch (const std::bad_alloc &) {
    show("error", "out of memory");
    return 1;
  } catch (const std::exception &e) {
    show("error", std::string("unexpected: ") + e.what());
    return 1;
  }
  // Output that could not be written (a full disk behind a redirection) is work that failed.
  if (std::fflush(stdout) != 0) {
    show("error", "standard output could not be written");
    return 1;
  }
  return context.exit_status;
}
