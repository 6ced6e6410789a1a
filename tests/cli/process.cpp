// SPDX-License-Identifier: Apache-2.0
#include "cli/process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>

namespace sunstone::test {

namespace {

// The child's side between fork and exec: nothing but system calls.
[[noreturn]] void become(char *const *arguments, const char *folder, int out, int error) {
  if (dup2(out, STDOUT_FILENO) < 0 || dup2(error, STDERR_FILENO) < 0) _exit(126);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  if (folder && chdir(folder) != 0) _exit(126);
  execv(SUNSTONE_BINARY, arguments);
  _exit(127);
}

struct Pipe {
  int ends[2];
  Pipe() {
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    for (const int end : ends)
      if (end >= 0) close(end);
  }
  void close_writer() {
    close(ends[1]);
    ends[1] = -1;
  }
  // Takes what is there.
  void drain(std::string &text) {
    std::array<char, 4096> bytes;
    for (ssize_t count; (count = read(ends[0], bytes.data(), bytes.size())) > 0;) text.append(bytes.data(), static_cast<std::size_t>(count));
  }
};

}  // namespace

Ended run_sunstone(const std::vector<std::string> &words, const RunOptions &run) {
  std::vector<std::string> all{"sunstone"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char *> arguments;
  for (std::string &word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Pipe out, error;
  const int file = run.out_to.empty() ? -1 : open(run.out_to.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (!run.out_to.empty() && file < 0) throw std::runtime_error("cannot open " + run.out_to);
  const auto begun = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(arguments.data(), run.folder.empty() ? nullptr : run.folder.c_str(), file >= 0 ? file : out.ends[1], error.ends[1]);
  out.close_writer();
  error.close_writer();
  if (file >= 0) close(file);

  Ended ended;
  int status = 0;
  rusage used{};
  for (;;) {
    pollfd waiting[2] = {{out.ends[0], POLLIN, 0}, {error.ends[0], POLLIN, 0}};
    poll(waiting, 2, 10);
    out.drain(ended.out);
    error.drain(ended.error);
    if (wait4(child, &status, WNOHANG, &used) == child) break;
    ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (ended.seconds > run.timeout && !ended.timed_out) {
      ended.timed_out = true;
      kill(child, SIGKILL);
    }
    if (run.meanwhile) run.meanwhile(child, ended.out);
    if ((waiting[0].revents | waiting[1].revents) & POLLHUP) usleep(1000);
  }
  ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  out.drain(ended.out);
  error.drain(ended.error);
  ended.peak_kilobytes = used.ru_maxrss;
  if (WIFEXITED(status)) ended.status = WEXITSTATUS(status);
  else ended.signal = WTERMSIG(status);
  return ended;
}

std::vector<std::string> lines_of(const std::string &text, const std::string &kind) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (line.starts_with("sunstone: " + kind + ":")) lines.push_back(line);
    at = end + 1;
  }
  return lines;
}

bool plain_text(const std::string &text) {
  return std::ranges::none_of(text, [](const char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; });
}

std::vector<std::string> listing(const std::filesystem::path &folder) {
  std::vector<std::string> names;
  for (const auto &entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string scene(const std::string &name) { return (std::filesystem::path(SUNSTONE_SOURCE_DIR) / "scenes" / name).string(); }

}  // namespace sunstone::test
