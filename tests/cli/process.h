// SPDX-License-Identifier: Apache-2.0
// Runs the binary as a shell would: arguments in, exit status and both streams out.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace sunstone::test {

struct Ended {
  int status = -1;      // of exit(); -1 where a signal ended it
  int signal = 0;
  bool timed_out = false;
  double seconds = 0;
  long peak_kilobytes = 0;
  std::string out, error;
};

struct RunOptions {
  std::filesystem::path folder;   // that it runs in
  double timeout = 120;           // seconds; after that it is killed
  std::string out_to;             // a file for its standard output, instead of a pipe
  // Called about 100 times a second with what it has written so far; may send signals.
  std::function<void(pid_t process, const std::string &out)> meanwhile;
};

// `sunstone words...`. Standard output and error are pipes.
Ended run_sunstone(const std::vector<std::string> &words, const RunOptions &run = {});

// The lines of a stream that begin with "sunstone: kind:".
std::vector<std::string> lines_of(const std::string &text, const std::string &kind);

// No byte that a terminal would act on; line feeds aside.
bool plain_text(const std::string &text);

// Names in a folder, sorted.
std::vector<std::string> listing(const std::filesystem::path &folder);

// scenes/<name> of this source tree.
std::string scene(const std::string &name);

}  // namespace sunstone::test
