// SPDX-License-Identifier: Apache-2.0
// A figure of the course: what it needs to be drawn, and the table of all.
#pragma once
#include <optional>
#include <span>

#include "learn/page.h"
#include "learn/plot.h"
#include "learn/studio.h"

namespace sunstone {

// Where a figure is drawn: the studio that renders, the folder that it writes into, and how large all is to be.
struct Easel {
  Studio &studio;
  std::filesystem::path folder;
  bool quick = false;  // tiny, for a first look and for tests: the same steps, worth nothing as a measurement
  struct Asked {
    Shot shot;
    int x = 0, y = 0;      // `paths`: which pixel, and which samples of it
    SampleRange samples;
    std::string command;   // as it was typed, for the page
  };
  std::optional<Asked> asked = {};  // of the command line, where a figure takes a scene; without it the Cornell box

  // Full size or tiny.
  template <class T> T size(T full, T tiny) const { return quick ? tiny : full; }
  // folder/name; and a PNG of a view there.
  std::filesystem::path file(const std::string &name) const { return folder / name; }
  // The plot as a file of its own, and as it goes into the page.
  std::string keep_plot(const std::string &name, const std::string &svg) const;
};

struct Figure {
  const char *name, *title, *summary;
  double seconds;  // planned on two idle cores at full size: shares of `learn all`
  // Writes pictures, a CSV and the page; returns the finding in a sentence, with what was measured, for the index and the terminal.
  std::string (*draw)(Easel &easel);
};

// In the order of the lecture. What `learn all` draws.
std::span<const Figure> figures();

// UsageError with the names there are.
const Figure &figure(const std::string &name);

std::string draw_bounces(Easel &easel);
std::string draw_convergence(Easel &easel);
std::string draw_light_sampling(Easel &easel);
std::string draw_depth(Easel &easel);
std::string draw_pseudo_code(Easel &easel);
std::string draw_l1_l2(Easel &easel);
std::string draw_branching(Easel &easel);
std::string draw_history(Easel &easel);
std::string draw_strategies(Easel &easel);
std::string draw_paths(Easel &easel);

// Draws each of `wanted`, with an index page beside them where there are several. Returns their findings.
struct Drawn {
  const Figure *figure;
  std::string finding;
};
std::vector<Drawn> draw_all(Easel &easel, std::span<const Figure> wanted, const std::function<void(const Drawn &)> &done);

}  // namespace sunstone
