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
  Statistics whole, reflected;      // of the picture, and of it without the lamp as the camera sees it
  std::vector<double> variance;     // of a sample, of what was scattered so many times
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
  const auto of_bounces = [&](unsigned first, unsigned last) {
    std::vector<Film> parts;
    for (const Film &film : all) parts.push_back(bounces_of(film, first, last));
    return statistics_of(parts);
  };
  spent.whole = statistics_of(all);
  spent.reflected = of_bounces(1, deepest);
  for (unsigned d = 0; d <= deepest; d++) spent.variance.push_back(of_bounces(d, d).variance);
  spent.film = all[0];
  for (unsigned i = 1; i < films; i++) add_film(spent.film, all[i]);
  return spent;
}

}  // namespace

std::string draw_branching(Easel &easel) {
  const int side = easel.size(32, 8);
  const unsigned films = easel.size(8u, 2u);
  const std::size_t count = std::size(trees);
  std::vector<Spent> spent;
  // The largest tree once a pixel and film: what one sample of it takes, all others may spend.
  const double rays = easel.size(4300.0, 600.0);
  for (const RayTree &tree : trees) spent.push_back(spend(easel, shot_of(easel, tree, side), films, rays, 1.0 / static_cast<double>(count), name_of(tree)));

  const Spent &path = spent[0], &web = spent[3];
  const double whole = mean_luminance(beauty_of(path.film)), reflected = mean_luminance(beauty_of(bounces_of(path.film, 1, deepest)));
  std::vector<double> light;
  for (unsigned d = 0; d <= deepest; d++) light.push_back(mean_luminance(beauty_of(bounces_of(path.film, d, d))));

  Table table{{"tree", "flags", "samples a pixel", "rays a sample", "rays a pixel", "mean luminance", "standard error", "variance of a sample", "variance × rays", "against a path", "so without the rays of the last depth", "so with the lamp's own edges"}, {}};
  Table depths{{"depth", "% of reflected light"}, {}}, variances{{"depth"}, {}};
  std::vector<Picture> pictures;
  std::vector<double> children, cost;
  const auto against = [&](const Spent &s) { return s.reflected.variance * s.rays / (path.reflected.variance * path.rays); };
  const auto against_of_use = [&](const Spent &s) { return s.reflected.variance * s.of_use / (path.reflected.variance * path.of_use); };
  const auto against_whole = [&](const Spent &s) { return s.whole.variance * s.rays / (path.whole.variance * path.rays); };
  for (std::size_t i = 0; i < count; i++) {
    const Spent &s = spent[i];
    const double samples = static_cast<double>(s.samples * films);
    table.rows.push_back({name_of(trees[i]), flags_of(trees[i]), fmt::format("{:.0f}", samples), fmt::format("{:.1f}", s.rays), fmt::format("{:.0f}", samples * s.rays), fmt::format("{:.5f}", s.reflected.mean),
                          fmt::format("{:.2g}", s.reflected.mean_error), fmt::format("{:.4g}", s.reflected.variance), fmt::format("{:.4g}", s.reflected.variance * s.rays), fmt::format("{:.2f}", against(s)),
                          fmt::format("{:.2f}", against_of_use(s)), fmt::format("{:.2f}", against_whole(s))});
    depths.columns.push_back("rays, " + name_of(trees[i]));
    variances.columns.push_back("variance, " + name_of(trees[i]));
    if (trees[i].shadow_rays == 1) children.push_back(trees[i].children), cost.push_back(against(s));
    const std::filesystem::path file = easel.file(fmt::format("branching-{}-{}.png", trees[i].children, trees[i].shadow_rays));
    write_png(file, s.film);
    pictures.push_back({file, fmt::format("{}: {:.0f} samples a pixel, {} rays", name_of(trees[i]), samples, show_number(samples * s.rays, 5))});
  }
  for (unsigned d = 0; d <= deepest; d++) {
    std::vector<std::string> row = {std::to_string(d), d ? fmt::format("{:.2f}", 100 * light[d] / reflected) : ""}, noise = {std::to_string(d)};
    for (const Spent &s : spent) row.push_back(fmt::format("{:.2f}", s.by_depth[d])), noise.push_back(fmt::format("{:.4g}", s.variance[d]));
    depths.rows.push_back(row);
    if (d) variances.rows.push_back(noise);
  }
  write_csv(easel.file("branching.csv"), table);
  write_csv(easel.file("branching-depths.csv"), depths);
  write_csv(easel.file("branching-variances.csv"), variances);

  const auto share = [](const Spent &s, unsigned d) {
    double sum = 0;
    for (const double r : s.by_depth) sum += r;
    return s.by_depth[d] / sum;
  };
  const std::string finding =
      fmt::format("A sample with sixteen rays at each hit has {:.2f} times the variance of a path and costs {:.0f} times the rays: for equal rays the variance is {} times that of a path ({} times if rays of the last depth are not counted). {:.1f} % of the tree's rays are at "
                  "depth {}, for {:.1f} % of the reflected light.",
                  web.reflected.variance / path.reflected.variance, web.rays / path.rays, show_number(against(web), 3), show_number(against_of_use(web), 3), 100 * share(web, deepest), deepest, 100 * light[deepest] / reflected);
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
                        "asked for. They lower the noise behind them alone, of light that has been scattered again. Measured depth by depth, the variance of one sample of the tree with sixteen rays is {:.2f} times that of a path at depth 1, {:.3f} times at "
                        "depth 2 and {:.3f} times at depth {}.",
                        web.variance[1] / path.variance[1], web.variance[2] / path.variance[2], web.variance[deepest] / path.variance[deepest], deepest));
  page.table(variances);
  page.text(fmt::format("Sixteen paths instead of one have a sixteenth of the variance, {:.3f}, at every depth at once, and take {:.0f} rays. The tree takes {:.0f}: depth by depth sixteen times as many, while the light goes the other way. Depth 1 holds {:.1f} % of what is "
                        "reflected here, depth {} {:.1f} %.",
                        1.0 / 16, 16 * path.rays, web.rays, 100 * light[1] / reflected, deepest, 100 * light[deepest] / reflected));
  const Spent &both = spent[4];
  page.text(fmt::format("Sixteen shadow rays at each hit as well lower the first hit's noise too, to {:.2f} times that of a path, yet for {:.0f} times the rays: {} times the variance of a path for equal rays. Roulette is off in all of these, so that "
                        "trees have the size that they are said to have.",
                        both.variance[1] / path.variance[1], both.rays / path.rays, show_number(against(both), 3)));
  page.heading("What was measured");
  Table shown = table;  // the flags go into the CSV alone
  shown.columns.erase(shown.columns.begin() + 1);
  for (std::vector<std::string> &row : shown.rows) row.erase(row.begin() + 1);
  page.table(shown);
  page.table(depths);
  page.text(fmt::format("Rays are camera, bounce and shadow rays, as the device counted them. Variance is of a sample's luminance in its pixel, averaged over {0} × {0} pixels, from {1} films of independent samples; samples are whole, so rays a pixel are equal but for "
                        "rounding. It is of reflected light: the lamp itself, seen by the camera, has edges in a few pixels that would outweigh all else, and no ray behind the camera's changes them (the last column has them in). "
                        "`hybrid` counts nothing at the end of its last ray but what mirrors lead to; the column without those rays is the kindest to trees. Mean luminance of the whole picture, lamp included: {2}.", side, films, show_number(whole)));
  page.command(fmt::format("sunstone render {} --integrator hybrid --indirect-samples 16 --absorption 0 --max-depth {} --sampler independent --filter box --size {}x{} --spp 4 -o tree.png",
                           easel.asked ? "SCENE" : "scenes/cornell/cornell.gltf", deepest, side, side));
  page.write(easel.file("branching.html"));
  return finding;
}

}  // namespace sunstone
