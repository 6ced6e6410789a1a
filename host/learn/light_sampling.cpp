// SPDX-License-Identifier: Apache-2.0
// With and without light sampling, at equal time.
#include <fmt/format.h>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

struct Contestant {
  const char *integrator, *is;
};
constexpr Contestant contestants[] = {{"pure", "light is met by chance"}, {"hybrid", "light is sampled, and what a path meets counts only where no shadow ray could"}, {"path", "both, weighted"}};

struct Place {
  const char *scene, *name, *title, *says;
  int width, height;
  unsigned depth;
};
constexpr Place places[] = {
    {"cornell/cornell.gltf", "cornell", "A small lamp in a room", "The lamp is a small part of what a surface sees, so chance finds it seldom and a shadow ray nearly always.", 128, 128, 8},
    {"veach-mis/veach-mis.gltf", "plates", "Lamps of four sizes over plates of four roughnesses",
     "A sharp plate sends light almost one way: a shadow ray to a large lamp misses that way, a path that follows the plate's own lobe hits it. Sampling lights alone is not enough here, weights are.", 144, 96, 4}};

}  // namespace

std::string draw_light_sampling(Easel &easel) {
  const double seconds = easel.size(2.0, 0.05);
  Table table{{"scene", "integrator", "seconds", "samples a pixel", "rays", "RMSE", "relMSE", "pure's time over its, for one error"}, {}};
  Page page("With and without light sampling", "The same seconds, three ways to find the light.");
  std::string finding;
  for (const Place &place : places) {
    RenderSettings settings = figure_settings(easel.size(place.width, 12), easel.size(place.height, 8), "path", place.depth);
    settings.layers.bounces = false;
    Shot shot{place.scene, "", settings};
    shot.settings.seed = 1000;  // of no contestant
    Image reference;
    {
      const auto renderer = easel.studio.renderer(shot);
      easel.studio.piece(0.35, fmt::format("{}: the reference", place.name));
      easel.studio.render(*renderer, {0, easel.size<std::uint64_t>(4096, 64)});
      reference = beauty_of(renderer->film());
    }
    shot.settings.seed = 0;
    std::vector<Picture> pictures, errors;
    std::vector<double> relmse, took;
    for (const Contestant &c : contestants) {
      shot.settings.integrator = c.integrator;
      const auto renderer = easel.studio.renderer(shot);
      easel.studio.piece(0.05, fmt::format("{}: {} for {} s", place.name, c.integrator, seconds));
      const double passed = easel.studio.render_for(*renderer, 0, seconds);
      const Image image = beauty_of(renderer->film());
      const Comparison error = load_content().compare_images(image, reference);
      const RenderCounts &counts = renderer->counts();
      relmse.push_back(error.relmse);
      took.push_back(passed);
      const std::string stem = fmt::format("light-sampling-{}-{}", place.name, c.integrator);
      write_png(easel.file(stem + ".png"), renderer->film());
      write_png(easel.file(stem + "-error.png"), error_map(image, reference, 0.25));
      pictures.push_back({easel.file(stem + ".png"), fmt::format("`{}`: {}. {} samples, relMSE {}", c.integrator, c.is, show_number(static_cast<double>(renderer->film().sample_count()), 6), show_number(error.relmse, 3))});
      errors.push_back({easel.file(stem + "-error.png"), fmt::format("error of `{}`: black is none, white 0.25 and more", c.integrator)});
      table.rows.push_back({place.name, c.integrator, fmt::format("{:.2f}", passed), std::to_string(renderer->film().sample_count()), std::to_string(counts.camera_rays + counts.bounce_rays + counts.shadow_rays),
                            fmt::format("{:.5g}", error.rmse), fmt::format("{:.5g}", error.relmse), fmt::format("{:.3g}", relmse[0] * took[0] / (error.relmse * passed))});
    }
    page.heading(place.title);
    page.pictures(pictures);
    page.pictures(errors);
    page.text(place.says);
    const double hybrid = relmse[0] * took[0] / (relmse[1] * took[1]), path = relmse[0] * took[0] / (relmse[2] * took[2]);
    const std::string found = fmt::format("{}: to the same error `hybrid` takes {} of the time of `pure`, and `path` {}.", place.title, show_number(1 / hybrid, 2), show_number(1 / path, 2));
    page.text(found);
    finding += (finding.empty() ? "" : " ") + found;
  }
  write_csv(easel.file("light-sampling.csv"), table);
  page.heading("What was measured");
  page.table(table);
  page.text("Seconds are of rendering alone, kernels compiled and warm. The error falls with one over the samples, so the ratio of relMSE × seconds is how much sooner one reaches the error of the other. relMSE is the mean over "
            "pixels and channels of (x − r)² / (r² + 0.01), nothing trimmed, r a render by `path` of 4 096 samples a pixel from another seed, whose own error is in the figures too: the smallest are a little too large. Direct light is not counted twice: what a shadow ray can find, a path that hits it does not add "
            "(`hybrid`), or both are weighted to a sum of one (`path`, the power heuristic of Veach and Guibas).");
  page.command(fmt::format("sunstone render scenes/cornell/cornell.gltf --integrator hybrid --size 128x128 --filter box --max-depth 8 --time {} -o hybrid.png", seconds));
  page.write(easel.file("light-sampling.html"));
  return finding;
}

}  // namespace sunstone
