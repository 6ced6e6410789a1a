// SPDX-License-Identifier: Apache-2.0
// The completion scripts, run in the shells themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "cli/commands.h"
#include "support/temporary_folder.h"

namespace sunstone {

using test::TemporaryFolder;

namespace {

// Much of what the real command has: commands, commands of commands, groups, choices, hidden options and awkward descriptions.
struct Program {
  CLI::App app;
  CommandContext context;
  std::string text;
  bool flag = false;
  Program() {
    app.set_help_flag("-h,--help", "Show help");
    CLI::App *render = app.add_subcommand("render", "Render a scene: it's \"quick\" & $(safe) `too` \\ [x]\nsecond line");
    render->add_option("scene", text, "The scene")->type_name("SCENE");
    render->add_option("-o,--output", text, "Write this file")->type_name("FILE");
    render->add_option("--sampler", text, "Points")->type_name("sobol|independent");
    render->add_option("--spp", text, "Samples a pixel")->type_name("N");
    render->add_option("--device", text, "Where")->type_name("SELECTOR");
    render->add_option("--secret", text, "Hidden")->group("");
    render->add_option_group("view", "How it looks")->add_option("--exposure", text, "Stops")->type_name("EV|auto");
    render->add_flag("-q,--quiet", flag, "Say nothing");
    app.add_subcommand("devices", "List the devices");
    CLI::App *cache = app.add_subcommand("cache", "The program cache");
    cache->add_subcommand("clear", "Empty it")->add_flag("--all", flag, "All of it");
    app.add_subcommand("ghost", "Hidden")->group("");
    add_compare(app, context);
    add_merge(app, context);
    add_completion(app, context);
  }
};

struct ShellRun {
  int status = -1;
  std::string text;
};

ShellRun run(const std::string &command) {
  ShellRun result;
  FILE *pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return result;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) result.text.append(buffer.data(), n);
  result.status = pclose(pipe);
  return result;
}

bool there(const std::string &shell) { return run("command -v " + shell).status == 0; }

void write_text(const std::filesystem::path &path, const std::string &text) { write_file(path, std::as_bytes(std::span(text))); }

std::vector<std::string> words_in(const std::string &text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

// What bash offers for a line whose last word is being typed.
class Bash {
 public:
  Bash() {
    write_text(folder_ / "script", completion_script(program_.app, "bash"));
    write_text(folder_ / "scene.gltf", "");
  }
  std::vector<std::string> complete(const std::vector<std::string> &line) {
    std::string text = "cd '" + (folder_ / "").string() + "' && source ./script && COMP_WORDS=(";
    for (const std::string &word : line) text += "'" + word + "' ";
    text += ") COMP_CWORD=" + std::to_string(line.size() - 1) + " && _sunstone && printf '%s\\n' \"${COMPREPLY[@]}\"\n";
    write_text(folder_ / "ask", text);
    const ShellRun result = run("bash --norc '" + (folder_ / "ask").string() + "'");
    EXPECT_EQ(result.status, 0) << result.text;
    return words_in(result.text);
  }
  ShellRun check() { return run("bash -n '" + (folder_ / "script").string() + "'"); }

 private:
  TemporaryFolder folder_;
  Program program_;
};

using Words = std::vector<std::string>;

}  // namespace

TEST(Completion, Bash) {
  if (!there("bash")) GTEST_SKIP() << "bash is not installed";
  Bash bash;
  const ShellRun check = bash.check();
  EXPECT_EQ(check.status, 0) << check.text;
  EXPECT_EQ(bash.complete({"sunstone", "re"}), Words{"render"});
  EXPECT_EQ(bash.complete({"sunstone", ""}), (Words{"render", "devices", "cache", "compare", "merge", "completion"}));
  EXPECT_EQ(bash.complete({"sunstone", "--h"}), Words{"--help"});
  EXPECT_EQ(bash.complete({"sunstone", "render", "--s"}), (Words{"--sampler", "--spp"})) << "and not the hidden one";
  EXPECT_EQ(bash.complete({"sunstone", "render", "--exp"}), Words{"--exposure"}) << "from a group of options";
  EXPECT_EQ(bash.complete({"sunstone", "render", "--sampler", ""}), (Words{"sobol", "independent"}));
  EXPECT_EQ(bash.complete({"sunstone", "render", "--sampler", "=", "in"}), Words{"independent"});
  EXPECT_EQ(bash.complete({"sunstone", "render", "--sampler", "="}), (Words{"sobol", "independent"}));
  EXPECT_EQ(bash.complete({"sunstone", "render", "--exposure", ""}), Words{"auto"});
  EXPECT_EQ(bash.complete({"sunstone", "render", "--spp", ""}), Words{}) << "a number, no file";
  Words files = bash.complete({"sunstone", "render", "sc"});
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, (Words{"scene.gltf", "script"}));
  EXPECT_EQ(bash.complete({"sunstone", "render", "-o", "scene"}), Words{"scene.gltf"});
  EXPECT_EQ(bash.complete({"sunstone", "cache", ""}), Words{"clear"});
  EXPECT_EQ(bash.complete({"sunstone", "cache", "clear", "-"}).size(), 3u) << "-h --help --all";
  EXPECT_EQ(bash.complete({"sunstone", "merge", "a.film", "--tone", ""}), (Words{"none", "filmic"}));
  EXPECT_EQ(bash.complete({"sunstone", "completion", ""}), (Words{"bash", "zsh", "fish"}));
  // A value that looks like a command is skipped as what it is.
  EXPECT_EQ(bash.complete({"sunstone", "render", "--device", "devices", "--sam"}), Words{"--sampler"});
}

TEST(Completion, Zsh) {
  if (!there("zsh")) GTEST_SKIP() << "zsh is not installed";
  const TemporaryFolder folder;
  write_text(folder / "_sunstone", completion_script(Program().app, "zsh"));
  const ShellRun check = run("zsh -n '" + (folder / "_sunstone").string() + "'");
  EXPECT_EQ(check.status, 0) << check.text;
  EXPECT_EQ(check.text, "");
}

TEST(Completion, Fish) {
  if (!there("fish")) GTEST_SKIP() << "fish is not installed";
  const TemporaryFolder folder;
  write_text(folder / "sunstone.fish", completion_script(Program().app, "fish"));
  const auto complete = [&](const std::string &line) {
    const ShellRun result = run("fish --no-config -c \"source '" + (folder / "sunstone.fish").string() + "'; complete -C '" + line + "'\" | cut -f1");
    EXPECT_EQ(result.status, 0) << result.text;
    return words_in(result.text);
  };
  EXPECT_EQ(complete("sunstone re"), Words{"render"});
  EXPECT_EQ(complete("sunstone render --sa"), Words{"--sampler"});
  EXPECT_EQ(complete("sunstone render --sampler i"), Words{"independent"});
  EXPECT_EQ(complete("sunstone cache cl"), Words{"clear"});
  EXPECT_EQ(complete("sunstone render --device devices --samp"), Words{"--sampler"});
}

TEST(Completion, OtherShellsAreUsageErrors) {
  EXPECT_THROW(completion_script(Program().app, "tcsh"), UsageError);
}

}  // namespace sunstone
