// SPDX-License-Identifier: Apache-2.0
// What a command says while it works: a bar on a terminal, plain lines in a pipe.
#pragma once
#include <chrono>
#include <string>

namespace sunstone {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  void line(const std::string &text);  // said once, above the bar
  // `fraction` of the work is done; `text` says what there is to know. On a terminal drawn over itself ten times a second, in a pipe a line now and then.
  void bar(double fraction, const std::string &text);
  void end_bar();
  static double seconds();  // since the process began

 private:
  bool quiet_, terminal_, drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
  double last_fraction_ = 0;
};

// "1:02:03" or "12.3 s".
std::string show_seconds(double seconds);
// "1.2 M", "345 k".
std::string show_count(double count);

}  // namespace sunstone
