// SPDX-License-Identifier: Apache-2.0
// The argument against branching: equal numbers of rays, spent on trees and on paths.
#include <fmt/format.h>

#include <cmath>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

constexpr unsigned deepest = 3;  // of the web page that the lecture quotes: 16 rays at a hit, three bounces

struct RayTree {
  unsigned children, shadow_rays;
};
// The first is what the others are held against: a path.
constexpr RayTree trees[] = {{1, 1}, {2, 1}, {4, 1}, {16, 1}, {16, 16}};

struct Spent {
  std::uint64_t samples = 0;        // of each film
  double rays = 0, of_use = 0;      // a sample; of_use: without those that the depth limit lets find nothing
  std::vector<double> by_depth;     // traced after so many scatterings, a sample
  Statistics statistics;
  Film film;                        // all films together
};

std::string name_of(const RayTree &tree) { return tree.children == 1 ? "a path" : fmt::format("{} at each hit{}", tree.children, tree.shadow_rays > 1 ? fmt::format(", {} shadow rays", tree.shadow_rays) : ""); }
std::string flags_of(const RayTree &tree) { return fmt::format("--indirect-samples {} --light-samples {}", tree.children, tree.shadow_rays); }

Shot shot_of(const Easel &easel, const RayTree &tree, int side) {
  Shot shot{"cornell/cornell.gltf", "", figure_settings(side, side, "hybrid", deepest)};
  if (easel.asked) shot.scene = "", shot.environment = "";
  shot.settings.independent = true;
  shot.settings.indirect_samples = tree.children;
  shot.settings.light_samples = tree.shadow_rays;
  shot.settings.absorption = 0;  // each ray goes on to the limit: the trees are what they are said to be
  return shot;
}

double rays_of(const RenderCounts &c) { return static_cast<double>(c.camera_rays + c.bounce_rays + c.shadow_rays); }

// `films` films of independent samples, with as many samples each as make `rays` rays a pixel.
Spent spend(Easel &easel, const Shot &shot, unsigned films, double rays, double share, const std::string &name) {
  Spent spent;
  const double pixels = static_cast<double>(shot.settings.width) * shot.settings.height;
  {
    const auto renderer = easel.studio.renderer(shot);
    easel.studio.piece(0, name);
    easel.studio.render(*renderer, {1u << 20, (1u << 20) + 1});
    spent.samples = static_cast<std::uint64_t>(std::max(1.0, std::round(rays / (rays_of(renderer->counts()) / pixels))));
  }
  std::vector<Film> all;
  std::vector<double> begun(deepest + 1);
  double paths = 0, traced = 0;
  for (unsigned i = 0; i < films; i++) {
    const auto renderer = easel.studio.renderer(shot);
    easel.studio.piece(share / films, name);
    easel.studio.render(*renderer, {i * spent.samples, (i + 1) * spent.samples});
    const RenderCounts &c = renderer->counts();
    traced += rays_of(c);
    const std::vector<std::uint64_t> by_depth = rays_by_depth(c);
    for (unsigned d = 0; d <= deepest; d++) begun[d] += static_cast<double>(by_depth[d]);
    paths += static_cast<double>(c.paths);
    all.push_back(renderer->film());
  }
  for (const double rays_there : begun) spent.by_depth.push_back(rays_there / paths);
  spent.rays = traced / paths;
  spent.of_use = spent.rays - spent.by_depth.back();
  spent.statistics = statistics_of(all);
  spent.film = all[0];
  for (unsigned i = 1; i < films; i++) add_film(spent.film, all[i]);
  return spent;
}

}  // namespace

std::string draw_branching(Easel &easel) {
  const int side = easel.size(40, 8);
  const unsigned films = easel.size(4u, 2u);
  const std::size_t count = std::size(trees);
  std::vector<Spent> spent;
  // The largest tree once a pixel and film: what one sample of it takes, all others may spend.
  const double rays = easel.size(9000.0, 600.0);
  for (const RayTree &tree : trees) spent.push_back(spend(easel, shot_of(easel, tree, side), films, rays, 1.0 / static_cast<double>(count), name_of(tree)));

  const Spent &path = spent[0], &web = spent[3];
  const double whole = mean_luminance(beauty_of(path.film)), reflected = mean_luminance(beauty_of(bounces_of(path.film, 1, deepest)));
  std::vector<double> light;
  for (unsigned d = 0; d <= deepest; d++) light.push_back(mean_luminance(beauty_of(bounces_of(path.film, d, d))));

  Table table{{"tree", "flags", "samples a pixel", "rays a sample", "rays a pixel", "mean luminance", "standard error", "variance of a sample", "variance x rays", "against a path", "so without the rays of the last depth"}, {}};
  Table depths{{"depth", "% of reflected light"}, {}};
  std::vector<Picture> pictures;
  std::vector<double> children, cost;
  const double base = path.statistics.variance * path.rays, base_of_use = path.statistics.variance * path.of_use;
  for (std::size_t i = 0; i < count; i++) {
    const Spent &s = spent[i];
    const double samples = static_cast<double>(s.samples * films), times = s.statistics.variance * s.rays / base, of_use = s.statistics.variance * s.of_use / base_of_use;
    table.rows.push_back({name_of(trees[i]), flags_of(trees[i]), fmt::format("{:.0f}", samples), fmt::format("{:.1f}", s.rays), fmt::format("{:.0f}", samples * s.rays), fmt::format("{:.5f}", s.statistics.mean),
                          fmt::format("{:.2g}", s.statistics.mean_error), fmt::format("{:.4g}", s.statistics.variance), fmt::format("{:.4g}", s.statistics.variance * s.rays), fmt::format("{:.2f}", times), fmt::format("{:.2f}", of_use)});
    depths.columns.push_back("rays, " + name_of(trees[i]));
    if (trees[i].shadow_rays == 1) children.push_back(trees[i].children), cost.push_back(times);
    const std::filesystem::path file = easel.file(fmt::format("branching-{}-{}.png", trees[i].children, trees[i].shadow_rays));
    write_png(file, s.film);
    pictures.push_back({file, fmt::format("{}: {:.0f} samples a pixel, {} rays", name_of(trees[i]), samples, show_number(samples * s.rays, 5))});
  }
  for (unsigned d = 0; d <= deepest; d++) {
    std::vector<std::string> row = {std::to_string(d), d ? fmt::format("{:.2f}", 100 * light[d] / reflected) : ""};
    for (const Spent &s : spent) row.push_back(fmt::format("{:.2f}", s.by_depth[d]));
    depths.rows.push_back(row);
  }
  write_csv(easel.file("branching.csv"), table);
  write_csv(easel.file("branching-depths.csv"), depths);

  const auto share = [](const Spent &s, unsigned d) {
    double sum = 0;
    for (const double r : s.by_depth) sum += r;
    return s.by_depth[d] / sum;
  };
  const double worse = web.statistics.variance * web.rays / base, worse_of_use = web.statistics.variance * web.of_use / base_of_use;
  const std::string finding =
      fmt::format("A sample with sixteen rays at each hit has {:.2f} times the variance of a path and costs {:.0f} times the rays: for equal rays the variance is {} times that of a path ({} times if rays of the last depth are not counted). {:.1f} % of the tree's rays are at "
                  "depth {}, for {:.1f} % of the reflected light.",
                  web.statistics.variance / path.statistics.variance, web.rays / path.rays, show_number(worse, 3), show_number(worse_of_use, 3), 100 * share(web, deepest), deepest, 100 * light[deepest] / reflected);
  Page page("The argument against branching", "Equal numbers of rays: 16 × 16 × 16, or paths.");
  page.text("A page that the lecture quotes casts 16 rays at each hit, so three bounces make 16 × 16 × 16 = 4096 rays at the last. Here trees with 2, 4 and 16 rays at each hit stand beside paths, with as many rays a pixel each, to the same depth and for the same integral.");
  page.pictures(pictures);
  page.text(finding);
  std::vector<std::string> labels;
  Bars of_tree{"rays, 16 at each hit", {}}, of_path{"rays, a path", {}}, of_light{"reflected light", {}};
  for (unsigned d = 0; d <= deepest; d++) {
    labels.push_back(std::to_string(d));
    of_tree.values.push_back(100 * share(web, d));
    of_path.values.push_back(100 * share(path, d));
    of_light.values.push_back(d ? 100 * light[d] / reflected : 0);
  }
  page.plot(easel.keep_plot("branching-depths.svg", bar_plot("Where rays go and where light comes from", "depth (scatterings)", {"per cent", false}, labels, {of_tree, of_path, of_light})));
  page.plot(easel.keep_plot("branching.svg", line_plot("Variance for equal rays, against a path", {"rays at each hit", true}, {"times the variance of a path", true}, {{"measured", children, cost}})));
  page.heading("Why");
  page.text(fmt::format("All rays of a tree share its camera ray, and all that grow from one hit share that hit. Further rays cannot lower the noise that lies before them: where in the pixel the camera ray went, which point of the lamp the first shadow ray "
                        "asked for. They lower the noise behind them alone, of light that has been scattered again, and that is the smaller part: depth 1 holds {:.1f} % of the reflected light here, depth {} {:.1f} %. The rays go the other way: depth by depth "
                        "sixteen times as many. A path spends one ray at each depth, and what a tree would spend at the end it spends on new camera rays, which lower all of the noise at once.",
                        100 * light[1] / reflected, deepest, 100 * light[deepest] / reflected));
  page.text(fmt::format("More shadow rays at each hit help a tree where its first hit is what is noisy (the last row), yet not enough: {} times the variance of a path for equal rays. Roulette is off in all of these, so that trees have the size that they are said to have.",
                        show_number(spent[4].statistics.variance * spent[4].rays / base, 3)));
  page.heading("What was measured");
  page.table(table);
  page.table(depths);
  page.text(fmt::format("Rays are camera, bounce and shadow rays, as the device counted them. Variance is of a sample's luminance in its pixel, averaged over {0} × {0} pixels, from {1} films of independent samples; samples are whole, so rays a pixel are equal but for "
                        "rounding. `hybrid` counts nothing at the end of its last ray but what mirrors lead to; the column without them is the kindest to trees. Mean luminance of the whole picture, lamp included: {2}.", side, films, show_number(whole)));
  page.command(fmt::format("sunstone render {} --integrator hybrid --indirect-samples 16 --absorption 0 --max-depth {} --sampler independent --filter box --size {}x{} --spp 4 -o tree.png",
                           easel.asked ? "SCENE" : "scenes/cornell/cornell.gltf", deepest, side, side));
  page.write(easel.file("branching.html"));
  return finding;
}

}  // namespace sunstone
