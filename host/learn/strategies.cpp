// SPDX-License-Identifier: Apache-2.0
// The pyramid of bidirectional path tracing: each way to join a path's two ends, by itself and weighted [Veach97 fig. 10.3].
#include <fmt/format.h>

#include "base/error.h"
#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

std::vector<std::int64_t> bounce_values(const Film &film, unsigned depth) { return film.find(fmt::format("bounce.{}", depth))->values; }

const char *what_is(unsigned s, unsigned t) {
  if (s == 0) return "the eye's path runs into the lamp";
  if (t == 1) return "the lamp's path is joined with the lens";
  return s == 1 ? "a shadow ray to the lamp" : "joined in between";
}

}  // namespace

std::string draw_strategies(Easel &easel) {
  const unsigned deepest = easel.size(4u, 2u);
  const int side = easel.size(112, 12);
  const std::uint64_t samples = easel.size<std::uint64_t>(32, 2);
  Shot shot{"cornell-caustic/cornell-caustic.gltf", "", figure_settings(side, side, "bdpt", deepest)};

  unsigned pictures = 1;
  for (unsigned depth = 1; depth <= deepest; depth++) pictures += 2 * (depth + 2);
  const double piece = 1.0 / pictures;
  easel.studio.piece(piece, "all strategies");
  const auto whole = easel.studio.renderer(shot);
  easel.studio.render(*whole, {0, samples});

  Page page("The strategies of bidirectional path tracing", "A path of n scatterings has n + 2 vertices. (s, t) finds s of them from the lamp and t from the eye, and joins the two ends.");
  Table table{{"depth", "s,t", "is", "mean luminance, alone", "mean luminance, weighted", "% of this depth"}, {}};
  std::string finding;
  for (unsigned depth = 1; depth <= deepest; depth++) {
    std::vector<std::int64_t> left = bounce_values(whole->film(), depth);
    const double all = mean_luminance(beauty_of(bounces_of(whole->film(), depth, depth)));
    std::vector<Picture> alone, weighted;
    double most = -1;
    std::string strongest;
    for (unsigned s = 0; s <= depth + 1; s++) {
      const unsigned t = depth + 2 - s;
      double mean[2] = {0, 0};
      for (const bool unweighted : {true, false}) {
        shot.settings.strategy_s = s;
        shot.settings.strategy_t = t;
        shot.settings.unweighted = unweighted;
        easel.studio.piece(piece, fmt::format("{} scattering{}, strategy {},{}{}", depth, depth == 1 ? "" : "s", s, t, unweighted ? " alone" : ""));
        const auto renderer = easel.studio.renderer(shot);
        easel.studio.render(*renderer, {0, samples});
        const Film &film = renderer->film();
        mean[unweighted] = mean_luminance(beauty_of(film));
        const std::string name = fmt::format("strategies-{}-{}-{}.png", unweighted ? "alone" : "weighted", s, t);
        write_png(easel.file(name), film, static_cast<float>(depth - 1));
        (unweighted ? alone : weighted).push_back({easel.file(name), fmt::format("{},{}: {}", s, t, what_is(s, t))});
        if (unweighted) continue;
        const std::vector<std::int64_t> values = bounce_values(film, depth);
        for (std::size_t i = 0; i < left.size(); i++) left[i] -= values[i];
      }
      if (mean[0] > most) most = mean[0], strongest = fmt::format("{},{}", s, t);
      table.rows.push_back({std::to_string(depth), fmt::format("{},{}", s, t), what_is(s, t), fmt::format("{:.5g}", mean[1]), fmt::format("{:.5g}", mean[0]), fmt::format("{:.2f}", all > 0 ? 100 * mean[0] / all : 0.0)});
    }
    for (const std::int64_t value : left)
      if (value != 0) throw Error("learn strategies", fmt::format("the strategies of depth {} do not add up to the whole", depth), "this is a fault of sunstone: please report it");
    page.heading(fmt::format("{} scattering{}", depth, depth == 1 ? "" : "s"));
    page.pictures(alone, alone.size());
    page.pictures(weighted, weighted.size());
    const std::string found = fmt::format("After {} scattering{} strategy {} carries most, {:.0f} %.", depth, depth == 1 ? "" : "s", strongest, all > 0 ? 100 * most / all : 0.0);
    page.text("Above each by itself, as if there were no other; below with its weight. " + found);
    finding += (finding.empty() ? "" : " ") + found;
  }
  write_csv(easel.file("strategies.csv"), table);
  page.heading("What was measured");
  page.table(table);
  page.text(fmt::format("{} samples a pixel in every picture; those of each depth are shown twice as bright as those of the one before. The weighted pictures of a depth add up to that depth of the whole render, integer by integer: this page is not written "
                        "where they do not. Alone, every strategy has the same mean but for noise where it can find all the light. It cannot where the join would have to guess a mirror's or smooth glass's one direction: caustics on the "
                        "floor are black in all but the last column (the lamp's path goes through the glass by itself and is joined with the lens) and the first (a path from the eye runs into the small lamp by chance: a few bright "
                        "specks). The weights, the power heuristic over all strategies, give each path to those that find it well.",
                        samples));
  page.command(fmt::format("sunstone render scenes/cornell-caustic/cornell-caustic.gltf --integrator bdpt --strategy 2,1 --unweighted --size {0}x{0} --filter box --max-depth {1} --spp {2} -o 2-1.png", side, deepest, samples));
  page.write(easel.file("strategies.html"));
  return finding;
}

}  // namespace sunstone
