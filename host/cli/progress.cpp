// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace sunstone {

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDOUT_FILENO) != 0) {}
Progress::~Progress() { end_bar(); }

void Progress::line(const std::string &text) {
  if (quiet_) return;
  end_bar();
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

void Progress::bar(double fraction, const std::string &text) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  const double waited = std::chrono::duration<double>(now - last_).count();
  if (terminal_) {
    if (drawn_ && waited < 0.1 && fraction < 1) return;
    constexpr int width = 24;
    const int full = static_cast<int>(fraction * width + 0.5);
    std::printf("\r\033[K[%s%s] %3.0f%%  %s", std::string(static_cast<std::size_t>(full), '=').c_str(),
                std::string(static_cast<std::size_t>(width - full), ' ').c_str(), fraction * 100, text.c_str());
    drawn_ = true;
  } else {
    if (waited < 5 && fraction < last_fraction_ + 0.25) return;
    std::printf("%3.0f%%  %s\n", fraction * 100, text.c_str());
  }
  std::fflush(stdout);
  last_ = now;
  last_fraction_ = fraction;
}

void Progress::end_bar() {
  if (drawn_) std::printf("\n");
  drawn_ = false;
  last_fraction_ = 0;
}

double Progress::seconds() {
  // Field 22 of /proc/self/stat: when the process began, in ticks after the machine did.
  static const double began = [] {
    std::ifstream file("/proc/self/stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string field;
    for (int i = 3; i <= 22 && fields >> field; i++) {
    }
    return field.empty() ? 0.0 : std::strtod(field.c_str(), nullptr) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }();
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9 - began;
}

std::string show_seconds(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const long whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string show_count(double count) {
  if (count >= 1e9) return fmt::format("{:.2f} G", count / 1e9);
  if (count >= 1e6) return fmt::format("{:.2f} M", count / 1e6);
  if (count >= 1e3) return fmt::format("{:.1f} k", count / 1e3);
  return fmt::format("{:.0f}", count);
}

}  // namespace sunstone
