// SPDX-License-Identifier: Apache-2.0
// What each depth contributes: radiance and rays by number of scatterings.
#include <fmt/format.h>

#include <cmath>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

struct Depths {
  std::vector<double> depth, luminance, share, rays;  // share: of depths 1 and deeper; rays: traced after so many scatterings, a path
  Film film;
};

Depths measure(Easel &easel, const Shot &shot, std::uint64_t samples) {
  const auto renderer = easel.studio.renderer(shot);
  easel.studio.render(*renderer, {0, samples});
  Depths d;
  d.film = renderer->film();
  const RenderCounts &counts = renderer->counts();
  // Of what surfaces send back: the lamp itself, a few bright pixels, would outweigh the room.
  const double whole = mean_luminance(beauty_of(bounces_of(d.film, 1, shot.settings.max_depth)));
  const std::vector<std::uint64_t> rays = rays_by_depth(counts);
  for (unsigned depth = 0; depth <= shot.settings.max_depth; depth++) {
    d.depth.push_back(depth);
    d.luminance.push_back(mean_luminance(beauty_of(bounces_of(d.film, depth, depth))));
    d.share.push_back(d.luminance.back() / whole);
    d.rays.push_back(static_cast<double>(rays[depth]) / static_cast<double>(counts.paths));
  }
  return d;
}

}  // namespace

std::string draw_depth(Easel &easel) {
  const unsigned deepest = easel.size(16u, 4u);
  const int side = easel.size(160, 12);
  const Shot room{"cornell/cornell.gltf", "", figure_settings(side, side, "path", deepest)};
  easel.studio.piece(0.7, "the Cornell box by depth");
  const Depths cornell = measure(easel, room, easel.size<std::uint64_t>(512, 16));
  const Shot oven{"furnace/furnace.gltf", "", figure_settings(32, 32, "pure", deepest)};
  easel.studio.piece(0.3, "the furnace by depth");
  const Depths furnace = measure(easel, oven, easel.size<std::uint64_t>(512, 16));

  // The furnace's radiance after k scatterings is the k-th power of its albedo, in each channel.
  constexpr double albedo[3] = {0.5, 0.25, 0.75};
  std::vector<double> exact, measured;
  double largest = 0;
  for (unsigned k = 0; k <= deepest; k++) {
    exact.push_back(std::pow(albedo[2], k));
    double mean = 0;
    const FilmLayer &layer = *furnace.film.find(fmt::format("bounce.{}", k));
    for (std::size_t pixel = 0; pixel < furnace.film.pixels(); pixel++) mean += film_value(furnace.film, layer, pixel, 2) / static_cast<double>(furnace.film.pixels());
    measured.push_back(mean);
    if (k <= 8) largest = std::max(largest, std::fabs(mean / exact.back() - 1));
  }

  Table table{{"depth", "mean luminance", "% of depths from 1", "% up to here", "rays a path", "light a ray"}, {}};
  double sum = 0;
  std::vector<double> fall_depth, fall_log;
  for (unsigned k = 0; k <= deepest; k++) {
    if (k > 0) sum += cornell.share[k];
    table.rows.push_back({std::to_string(k), fmt::format("{:.5g}", cornell.luminance[k]), k ? fmt::format("{:.3f}", 100 * cornell.share[k]) : "", k ? fmt::format("{:.3f}", 100 * sum) : "", fmt::format("{:.4f}", cornell.rays[k]),
                          fmt::format("{:.4g}", cornell.rays[k] > 0 ? cornell.luminance[k] / cornell.rays[k] : 0.0)});
    if (k >= 2 && cornell.luminance[k] > 0) {
      fall_depth.push_back(k);
      fall_log.push_back(std::log(cornell.luminance[k]));
    }
  }
  write_csv(easel.file("depth.csv"), table);
  const Line fall = fit_line(fall_depth, fall_log);
  const double factor = std::exp(fall.slope);
  double beyond = 0;
  for (unsigned k = 4; k <= deepest; k++) beyond += cornell.share[k];
  const std::string finding = fmt::format("In the Cornell box each bounce from the second on carries {:.2f} times the light of the one before: depth 1 is {:.1f} % of what surfaces send to the camera, depths 1 to 3 are {:.1f} %.", factor, 100 * cornell.share[1],
                                          100 * (cornell.share[1] + cornell.share[2] + cornell.share[3]));

  std::vector<Picture> row;
  for (unsigned k = 0; k <= std::min(deepest, 5u); k++) {
    const std::filesystem::path file = easel.file(fmt::format("depth-{}.png", k));
    // Each two stops brighter than the one before, or there is nothing to see.
    const float stops = k < 2 ? 0.0f : static_cast<float>(k - 1);
    write_png(file, bounces_of(cornell.film, k, k), stops);
    row.push_back({file, fmt::format("depth {}: {}{}", k, k ? fmt::format("{:.2f} %", 100 * cornell.share[k]) : "the lamp itself", stops > 0 ? fmt::format(", shown {:.0f} times brighter", std::exp2(stops)) : "")});
  }
  Page page("What each depth contributes", "Light by the number of surfaces that scattered it.");
  page.pictures(row);
  page.text(finding + " Depth 0 is the lamp seen directly; depth 1 what it lights; the ceiling appears at depth 2, the reds and greens that walls lend to the blocks come with it.");
  page.plot(easel.keep_plot("depth.svg", line_plot("Light and rays by depth", {"depth (scatterings)", false}, {"per path", true},
                                                   {{"mean luminance, Cornell box", cornell.depth, cornell.luminance},
                                                    {"rays a path (of those that go on)", cornell.depth, cornell.rays},
                                                    {"furnace, blue channel", furnace.depth, measured},
                                                    {"furnace, exact: 0.75 to the power of depth", furnace.depth, exact, false, true}})));
  page.text(fmt::format("The furnace is a closed box whose walls shine with radiance 1 and reflect 0.5, 0.25 and 0.75: after k scatterings every pixel has those numbers to the power k. Measured against it, the blue channel is "
                        "within {:.2f} % at every depth up to {}. It is here to show that the layers are what they claim to be.", 100 * largest, std::min(deepest, 8u)));
  page.heading("Why this speaks against branching");
  const double branch = 16 + 256 + 4096, total = 1 + branch;
  page.text(fmt::format("A tracer that sends 16 rays at every hit and stops after three bounces spends 1 + 16 + 256 + 4 096 rays on a pixel's sample: {:.1f} % of them for depth 3, where {:.2f} % of the reflected light is, and "
                        "{:.2f} % on the camera ray, whose place in the pixel decides edges and textures. What is deeper ({:.2f} %) it never sees. A path spends one ray at each depth, and from the fifth scattering on "
                        "roulette ends it in the measure in which it has become dim: in the plot the rays then fall as fast as the light.",
                        100 * 4096 / total, 100 * cornell.share[3], 100 / total, 100 * beyond));
  page.table(table);
  page.command(fmt::format("sunstone render scenes/cornell/cornell.gltf --size {0}x{0} --filter box --max-depth {1} --aov bounce --spp 512 -o depths.exr", side, deepest));
  page.write(easel.file("depth.html"));
  return finding;
}

}  // namespace sunstone
