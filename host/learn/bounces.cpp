// SPDX-License-Identifier: Apache-2.0
// Path tracing with an environment light: zero bounces, one bounce, five.
#include <fmt/format.h>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

std::string draw_bounces(Easel &easel) {
  constexpr unsigned deepest = 5;
  const int width = easel.size(384, 24), height = easel.size(256, 16);
  const std::uint64_t samples = easel.size(256, 4);
  const Shot shot{"environment/environment.glb", "environment/sky.hdr", figure_settings(width, height, "path", deepest)};
  const auto renderer = easel.studio.renderer(shot);
  easel.studio.piece(1, "a mesh under a sky, up to five bounces");
  easel.studio.render(*renderer, {0, samples});
  const Film &film = renderer->film();

  Table table{{"bounces at most", "mean luminance", "% of five bounces", "this bounce alone"}, {}};
  std::vector<Picture> row;
  std::vector<double> means;
  const double whole = mean_luminance(beauty_of(film));
  for (unsigned depth = 0; depth <= deepest; depth++) {
    const double up_to = mean_luminance(beauty_of(bounces_of(film, 0, depth))), alone = mean_luminance(beauty_of(bounces_of(film, depth, depth)));
    means.push_back(alone);
    table.rows.push_back({std::to_string(depth), fmt::format("{:.5g}", up_to), fmt::format("{:.2f}", 100 * up_to / whole), fmt::format("{:.5g}", alone)});
    if (depth != 0 && depth != 1 && depth != deepest) continue;
    const std::filesystem::path file = easel.file(fmt::format("bounces-{}.png", depth));
    write_png(file, bounces_of(film, 0, depth));
    row.push_back({file, depth == 0 ? "Zero bounces: what the camera sees shining, the sky." : depth == 1 ? "One bounce: what the sky lights." : "Five bounces: what lit surfaces light in turn."});
  }
  write_csv(easel.file("bounces.csv"), table);

  const std::string finding = fmt::format("The sky alone is {:.1f} % of the light in this picture, one bounce brings it to {:.1f} %, and bounces 2 to 5 add the last {:.1f} %.", 100 * means[0] / whole,
                                          100 * (means[0] + means[1]) / whole, 100 * (1 - (means[0] + means[1]) / whole));
  Page page("Zero bounces, one bounce, five", "A mesh under an environment light.");
  page.pictures(row);
  page.text(finding + " Bounces count scatterings on surfaces: at zero there is only what shines by itself, so the mesh is a black shape before the sky. With one bounce it is lit, but a place that "
                      "does not see the sky is black. Further bounces carry light there: between the windings and up from the ground.");
  page.text(fmt::format("All pictures are of one render of {} samples a pixel. Each contribution is kept by its number of bounces, in integers, so the sum of the first layers is the picture that "
                        "`--max-depth` leaves, to the last bit.", samples));
  page.table(table);
  std::vector<std::string> labels;
  for (unsigned depth = 0; depth <= deepest; depth++) labels.push_back(std::to_string(depth));
  page.plot(easel.keep_plot("bounces.svg", bar_plot("Light by number of bounces", "bounces", {"mean luminance", true}, labels, {{"of this bounce alone", means}})));
  page.command(fmt::format("sunstone render scenes/environment/environment.glb --env scenes/environment/sky.hdr --size {}x{} --spp {} --filter box --max-depth 5 -o five.png", width, height, samples));
  page.write(easel.file("bounces.html"));
  return finding;
}

}  // namespace sunstone
