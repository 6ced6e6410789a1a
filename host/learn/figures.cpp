// SPDX-License-Identifier: Apache-2.0
// The table of figures, and the page that leads to them.
#include "base/error.h"
#include "base/file.h"
#include "learn/figure.h"

namespace sunstone {

std::string Easel::keep_plot(const std::string &name, const std::string &svg) const {
  write_file(file(name), std::as_bytes(std::span(svg)));
  return svg;
}

std::span<const Figure> figures() {
  static const Figure table[] = {
      {"bounces", "Zero bounces, one bounce, five", "a mesh under a sky: what each bounce adds", 20, draw_bounces},
      {"l1-l2", "The path from l1 to l2", "light that Whitted's ray tracing cannot find, and how much of the picture it is", 30, draw_l1_l2},
      {"convergence", "From 1 to 100 000 samples", "an area light at growing sample counts, the error curve and its slope, independent and Sobol'", 215, draw_convergence},
      {"light-sampling", "With and without light sampling", "pure, hybrid and path at equal time, with error maps", 100, draw_light_sampling},
      {"depth", "What each depth contributes", "radiance and rays by depth, and the closed furnace whose series is known", 12, draw_depth},
      {"branching", "The argument against branching", "trees of rays and paths at equal numbers of rays: rays and light by depth, variance", 115, draw_branching},
      {"pseudo-code", "The pseudo-code against pure path tracing", "each deviation alone: means, variances, rays; and the classic mistake", 60, draw_pseudo_code},
      {"strategies", "The strategies of bidirectional path tracing", "each way to join a path from the eye and one from a light, alone and weighted", 60, draw_strategies},
      {"history", "From Whitted to photon maps", "one room by each method of the history at equal time, with error maps", 180, draw_history},
      {"paths", "The paths of one pixel", "every vertex drawn over the picture and in a table, with pdf, throughput and contribution", 20, draw_paths},
  };
  return table;
}

const Figure &figure(const std::string &name) {
  std::string known;
  for (const Figure &f : figures()) {
    if (f.name == name) return f;
    known += (known.empty() ? "" : ", ") + std::string(f.name);
  }
  throw UsageError("learn " + printable(name), "no such figure; there are " + known + ", and all");
}

std::vector<Drawn> draw_all(Easel &easel, std::span<const Figure> wanted, const std::function<void(const Drawn &)> &done) {
  double all = 0, before = 0;
  for (const Figure &f : wanted) all += f.seconds;
  std::vector<Drawn> drawn;
  for (const Figure &f : wanted) {
    easel.studio.span(before / all, (before + f.seconds) / all);
    easel.studio.piece(0, f.name);
    drawn.push_back({&f, f.draw(easel)});
    before += f.seconds;
    if (done) done(drawn.back());
  }
  if (wanted.size() < 2) return drawn;
  Page index("A brief history of path tracing", "Figures of the course, each rendered and measured by sunstone on this machine. Every number on these pages was computed when they were written.");
  if (easel.quick) index.text("Drawn with `--quick`: tiny pictures and few samples, to see what there is. Its measurements are worth nothing.");
  for (const Drawn &d : drawn) index.link(std::string(d.figure->name) + ".html", d.figure->title, d.finding);
  index.command("sunstone learn all -o FOLDER");
  index.write(easel.file("index.html"));
  return drawn;
}

}  // namespace sunstone
