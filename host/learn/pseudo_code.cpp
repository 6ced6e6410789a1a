// SPDX-License-Identifier: Apache-2.0
// How the lecture's pseudo-code deviates from pure path tracing: each deviation alone, with its mean and its variance.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

struct Deviation {
  const char *name, *flags, *says;
  void (*set)(RenderSettings &s);
};

// The first of each list is what the others are held against.
const Deviation in_the_room[] = {
    {"pure", "--integrator pure", "the rendering equation as it stands: one ray goes on at each hit, light counts where a path meets it", [](RenderSettings &s) { s.integrator = "pure"; }},
    {"end-on-light", "--integrator pure --end-on-light", "the lecture's first rule, taken by the letter: a path ends on the light, though this lamp reflects 0.78 of what falls on it",
     [](RenderSettings &s) { s.integrator = "pure", s.end_on_light = true; }},
    {"uniform", "--integrator pure --sampling uniform", "directions drawn evenly over the hemisphere: `sample direction psi on hemisphere` read naively", [](RenderSettings &s) { s.integrator = "pure", s.sampling = Sampling::uniform; }},
    {"nee-every", "--integrator hybrid", "the pseudo-code: a shadow ray at every hit, light that a path meets later is not counted again", [](RenderSettings &s) { s.integrator = "hybrid"; }},
    {"nee-first", "--integrator hybrid --nee first", "the slide: shadow rays at the camera ray's hit alone, light that is met counts unless ray depth = 1", [](RenderSettings &s) { s.integrator = "hybrid", s.nee_first = true; }},
    {"four-shadow-rays", "--integrator hybrid --light-samples 4", "Nd = 4 shadow rays at each hit, each with a quarter of the worth", [](RenderSettings &s) { s.integrator = "hybrid", s.light_samples = 4; }},
    {"absorption", "--integrator hybrid --absorption 0.3", "roulette with a fixed chance, and 1 / (1 − absorption) for those that live", [](RenderSettings &s) { s.integrator = "hybrid", s.absorption = 0.3f; }},
    {"weighted", "--integrator path", "not in the pseudo-code: shadow rays and met lights both count, weighted to a sum of one", [](RenderSettings &s) { s.integrator = "path"; }},
    {"double-count", "--integrator hybrid --double-count", "the classic mistake, on purpose: a light that is met counts beside its shadow rays", [](RenderSettings &s) { s.integrator = "hybrid", s.double_count = true; }},
};
const Deviation on_the_plates[] = {
    {"plates-bsdf", "--integrator pure --sampling bsdf", "as the surface scatters", [](RenderSettings &s) { s.integrator = "pure"; }},
    {"plates-cosine", "--integrator pure --sampling cosine", "with the cosine alone", [](RenderSettings &s) { s.integrator = "pure", s.sampling = Sampling::cosine; }},
    {"plates-uniform", "--integrator pure --sampling uniform", "evenly", [](RenderSettings &s) { s.integrator = "pure", s.sampling = Sampling::uniform; }},
};

struct Measured {
  Statistics statistics;
  double rays = 0;  // a path
};

// Films of samples that are independent of each other, one behind the other.
Measured measure(Easel &easel, const Shot &shot, unsigned films, std::uint64_t samples, const char *name, const std::filesystem::path &png) {
  constexpr double deviations = std::size(in_the_room) + std::size(on_the_plates);
  std::vector<Film> all;
  double rays = 0, paths = 0;
  for (unsigned i = 0; i < films; i++) {
    const auto renderer = easel.studio.renderer(shot);
    easel.studio.piece(1 / (deviations * films), name);
    easel.studio.render(*renderer, {i * samples, (i + 1) * samples});
    const RenderCounts &c = renderer->counts();
    rays += static_cast<double>(c.camera_rays + c.bounce_rays + c.shadow_rays);
    paths += static_cast<double>(c.paths);
    all.push_back(renderer->film());
  }
  Film sum = all[0];
  for (unsigned i = 1; i < films; i++) add_film(sum, all[i]);
  write_png(png, sum);
  return {statistics_of(all), rays / paths};
}

}  // namespace

std::string draw_pseudo_code(Easel &easel) {
  const unsigned films = easel.size(16u, 2u);
  const std::uint64_t samples = easel.size<std::uint64_t>(64, 4);
  Table table{{"scene", "variant", "flags", "mean luminance", "standard error", "% against the first", "in standard errors", "variance of a sample", "rays a path", "variance x rays"}, {}};
  // On the page, a table a scene, whose first column is the number in the plot.
  Table shown[2];
  for (Table &t : shown) t.columns = {"", "`--integrator`", "mean luminance", "standard error", "% against the first", "in standard errors", "variance of a sample", "rays a path", "variance × rays"};
  std::string differing;  // whose mean is another one
  std::vector<Measured> found[2];
  std::vector<Picture> pictures[2];
  const auto run = [&](int group, std::span<const Deviation> variants, const char *scene, int width, int height, unsigned depth) {
    for (const Deviation &v : variants) {
      Shot shot{scene, "", figure_settings(easel.size(width, 12), easel.size(height, 8), "path", depth)};
      shot.settings.independent = true;
      shot.settings.layers.bounces = false;
      v.set(shot.settings);
      const std::filesystem::path png = easel.file(fmt::format("pseudo-code-{}.png", v.name));
      found[group].push_back(measure(easel, shot, films, samples, v.name, png));
      const Measured &m = found[group].back(), &first = found[group].front();
      const double apart = m.statistics.mean - first.statistics.mean, sigma = std::hypot(m.statistics.mean_error, first.statistics.mean_error);
      table.rows.push_back({std::filesystem::path(scene).stem().string(), v.name, v.flags, fmt::format("{:.5f}", m.statistics.mean), fmt::format("{:.2g}", m.statistics.mean_error),
                            fmt::format("{:+.2f}", 100 * apart / first.statistics.mean), &m == &first ? "" : fmt::format("{:+.1f}", apart / sigma), fmt::format("{:.4g}", m.statistics.variance), fmt::format("{:.2f}", m.rays),
                            fmt::format("{:.4g}", m.statistics.variance * m.rays)});
      if (&m != &first && std::fabs(apart) > 3 * sigma) differing += fmt::format("{}`{}`", differing.empty() ? "" : ", ", v.flags);
      std::vector<std::string> &row = shown[group].rows.emplace_back(table.rows.back());
      row.erase(row.begin(), row.begin() + 3);
      row.insert(row.begin(), {std::to_string(shown[group].rows.size()), "`" + std::string(v.flags).substr(std::strlen("--integrator ")) + "`"});
      pictures[group].push_back({png, fmt::format("`{}`: {}. Variance {}", v.flags, v.says, show_number(m.statistics.variance, 3))});
    }
  };
  run(0, in_the_room, "cornell/cornell.gltf", 96, 96, 8);
  run(1, on_the_plates, "veach-mis/veach-mis.gltf", 96, 64, 2);
  write_csv(easel.file("pseudo-code.csv"), table);

  const Measured &pure = found[0][0], &ends = found[0][1], &uniform = found[0][2], &every = found[0][3], &first = found[0][4], &twice = found[0][8];
  const auto against = [&](const Measured &m) { return 100 * (m.statistics.mean / pure.statistics.mean - 1); };
  const std::string finding = fmt::format("A shadow ray at every hit takes the variance of a sample from {} to {}, and leaves the mean where it was ({:+.2f} %); counting met lights as well makes the picture {:.0f} % too bright.",
                                          show_number(pure.statistics.variance, 3), show_number(every.statistics.variance, 3), against(every), against(twice));
  Page page("The pseudo-code against pure path tracing", "How does this code deviate, and why does it do that?");
  page.pictures(pictures[0]);
  page.text(finding + " All pictures have the same number of independent samples.");
  page.heading("Where it deviates");
  page.text(fmt::format("It splits light in two. `computeRadiance` adds direct and indirect illumination: direct light is sampled on the light's surface (`select light source k; sample point y`), and only what remains is left to a random direction. Pure path "
                        "tracing has no such split, it waits for a path to run into the lamp. Why: a lamp that fills a hundredth of the hemisphere is met once in a hundred rays. Measured here: variance {} against {}, with {:.2f} rays a path against {:.2f}.",
                        show_number(pure.statistics.variance, 3), show_number(every.statistics.variance, 3), pure.rays, every.rays));
  page.text(fmt::format("It counts emission once. `Le` stands in `rad` alone, for the camera ray; a light that an indirect ray meets adds nothing, since the vertex before has sampled it. Forget that and direct light is there twice: {:+.0f} % here, {:.0f} "
                        "standard errors away. So mirrors show no lamps, unless a light met after a mirror counts, where no shadow ray could have found it; `hybrid` does that. The slide's form, shadow rays at the first hit alone and `ray depth ≠ 1`, is another "
                        "division of the same sum: {:+.2f} % apart, variance {}.",
                        against(twice), (twice.statistics.mean - pure.statistics.mean) / std::hypot(twice.statistics.mean_error, pure.statistics.mean_error), against(first), show_number(first.statistics.variance, 3)));
  page.text("It ends paths by chance. Pure path tracing as the lecture draws it ends at a light, at the depth limit or outside; the code has `if (no absorption)` and divides by 1 − absorption. Without a limit on depth a recursion has to end somehow, "
            "and cutting it off loses light; roulette loses none on average, since survivors speak for those that died. It adds variance, and saves rays: compare variance × rays below.");
  page.text("It may branch. `for all indirect paths` sends Ni rays from a hit, and each does the same again. Path tracing has Ni = 1. And it loops over Nd shadow rays, which share a hit and its path before: they lower the variance of direct light there and of nothing else.");
  page.text(fmt::format("It samples the pixel's filter (`pick sample point p within support of h`) and divides by its integral; that is no deviation. And a path that ends on the light that it hits, the first rule on the slide, is the same only where lamps reflect "
                        "nothing. The Cornell lamp reflects 0.78, and ending there costs {:.2f} % of the light ({:.1f} standard errors).",
                        -against(ends), std::fabs(ends.statistics.mean - pure.statistics.mean) / std::hypot(ends.statistics.mean_error, pure.statistics.mean_error)));
  page.heading("What the pdf is worth");
  page.pictures(pictures[1]);
  page.text(fmt::format("`pdf(psi)` is free to choose. In the matt room drawing evenly instead of with the cosine raises the variance {:.2f} times. On metal plates, sharp ones above, drawing by the cosine raises it {} times and evenly {} times over drawing as the "
                        "surface scatters, and the sharpest plate has all but vanished into a few bright pixels. The expected picture is the same.",
                        uniform.statistics.variance / pure.statistics.variance, show_number(found[1][1].statistics.variance / found[1][0].statistics.variance, 2), show_number(found[1][2].statistics.variance / found[1][0].statistics.variance, 2)));
  std::vector<std::string> labels;
  Bars variance{"variance of a sample", {}}, cost{"variance × rays a path", {}};
  for (std::size_t i = 0; i < std::size(in_the_room); i++) {
    labels.push_back(std::to_string(i + 1));
    variance.values.push_back(found[0][i].statistics.variance);
    cost.values.push_back(found[0][i].statistics.variance * found[0][i].rays);
  }
  page.heading("What was measured");
  page.plot(easel.keep_plot("pseudo-code.svg", bar_plot("Noise of each variant in the Cornell box, in the order of the table", "variant", {"luminance²", true}, labels, {variance, cost})));
  page.text("In the Cornell box:");
  page.table(shown[0]);
  page.text("On the plates:");
  page.table(shown[1]);
  page.text(fmt::format("Means and variances are of {} films of {} independent samples a pixel each. The standard error is that of the whole picture's mean. Means that differ by more than about three of them differ in truth; here that is so for {}. "
                        "`--double-count` is wrong, and `--end-on-light` leaves out what the lamp reflects.",
                        films, samples, differing.empty() ? "none" : differing));
  page.command("sunstone render scenes/cornell/cornell.gltf --integrator hybrid --absorption 0.3 --sampler independent --size 96x96 --filter box --max-depth 8 --spp 1024 -o hybrid.png");
  page.write(easel.file("pseudo-code.html"));
  return finding;
}

}  // namespace sunstone
