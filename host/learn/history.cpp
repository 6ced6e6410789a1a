// SPDX-License-Identifier: Apache-2.0
// The history of the methods in one room, each with the same time.
#include <fmt/format.h>

#include <cmath>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

struct Chapter {
  const char *integrator, *who, *says;
};
constexpr Chapter chapters[] = {
    {"whitted", "Whitted 1980", "Mirrors, glass and lamps without extent (a spot light stands for the lamp). What matt walls send each other is one constant, the ambient term, and glass casts a plain shadow."},
    {"distribution", "Cook, Porter, Carpenter 1984", "Rays spread over the lamp: soft shadows. Light between matt walls is left out still, so what the lamp does not see is black."},
    {"pure", "Kajiya 1986", "All light, by one integral, and nothing known of where the lamp is: a path has to run into it."},
    {"path", "Kajiya 1986, Veach & Guibas 1995", "The same integral with shadow rays, weighted. Light that glass has gathered still is found by chance alone, so there are bright specks."},
    {"bdpt", "Lafortune & Willems 1993, Veach & Guibas 1995", "Paths from the lamp as well: the caustic is smooth. What the mirror and the glass show of it is not."},
    {"photon", "Jensen 1995, 1996", "Photons are kept where they land and looked up: the caustic is smooth, and so is what mirrors show of it; a little blurred, whatever the time."},
    {"sppm", "Hachisuka & Jensen 2009", "Photons in ever smaller disks: the blur goes as well."},
    {"vcm", "Georgiev, Křivánek, Davidovič & Slusallek 2012", "Photons as one more strategy of the bidirectional kind, weighted with the others."},
};

constexpr const char *reference_by = "vcm";
constexpr const char *lamp_scene = "cornell-caustic/cornell-caustic.gltf", *spot_scene = "cornell-caustic/spot-lamp.gltf";
constexpr unsigned deepest = 10;

// Of the pixels, in per cent: how many show another luminance than the reference, by more than a tenth of it. A bright pixel counts as one, however bright.
double pixels_off(const Image &image, const Image &reference) {
  const std::vector<float> &x = std::get<std::vector<float>>(image.pixels), &r = std::get<std::vector<float>>(reference.pixels);
  const auto luminance = [](const float *rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; };
  std::size_t off = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) off += std::fabs(luminance(&x[i]) - luminance(&r[i])) > 0.1 * luminance(&r[i]) + 1e-3;
  return 300 * static_cast<double>(off) / static_cast<double>(x.size());
}

}  // namespace

std::string draw_history(Easel &easel) {
  const double seconds = easel.size(8.0, 0.05), count = static_cast<double>(std::size(chapters));
  const int side = easel.size(192, 16);
  RenderSettings settings = figure_settings(side, side, reference_by, deepest);
  settings.layers.bounces = false;
  settings.seed = 1000;  // of no contestant
  Image reference;
  double whole = 0;
  {
    const auto renderer = easel.studio.renderer({lamp_scene, "", settings});
    easel.studio.piece(0.5, "the reference");
    easel.studio.render_for(*renderer, 0, easel.size(10 * seconds, 0.5));
    reference = beauty_of(renderer->film());
    write_png(easel.file("history-reference.png"), renderer->film());
    whole = mean_luminance(reference);
  }
  settings.seed = 0;
  Table table{{"method", "integrator", "seconds", "samples a pixel", "mean light, % of the reference", "RMSE", "relMSE", "% of pixels off by a tenth"}, {}};
  std::vector<Picture> pictures, errors;
  std::string finding;
  for (const Chapter &c : chapters) {
    RenderSettings own = settings;
    own.integrator = c.integrator;
    const bool spot = c.integrator == std::string("whitted");
    if (spot) own.ambient = {0.3f, 0.27f, 0.22f};
    const auto renderer = easel.studio.renderer({spot ? spot_scene : lamp_scene, "", own});
    easel.studio.piece(0.5 / count, c.integrator);
    const double passed = easel.studio.render_for(*renderer, 0, seconds);
    const Image image = beauty_of(renderer->film());
    const Comparison error = load_content().compare_images(image, reference);
    const double off = pixels_off(image, reference);
    const double light = 100 * mean_luminance(image) / whole;
    const std::string stem = fmt::format("history-{}", c.integrator);
    write_png(easel.file(stem + ".png"), renderer->film());
    write_png(easel.file(stem + "-error.png"), error_map(image, reference, 0.5));
    pictures.push_back({easel.file(stem + ".png"), fmt::format("{} (`{}`). {}", c.who, c.integrator, c.says)});
    errors.push_back({easel.file(stem + "-error.png"), fmt::format("error of `{}`: relMSE {}, {:.0f} % of the pixels off by a tenth", c.integrator, show_number(error.relmse, 3), off)});
    table.rows.push_back({c.who, c.integrator, fmt::format("{:.2f}", passed), std::to_string(renderer->film().sample_count()), fmt::format("{:.2f}", light), fmt::format("{:.5g}", error.rmse), fmt::format("{:.5g}", error.relmse), fmt::format("{:.1f}", off)});
    finding += fmt::format("{}`{}` {} ({:.0f} %)", finding.empty() ? "" : ", ", c.integrator, show_number(error.relmse, 3), off);
  }
  finding = fmt::format("relMSE after {} s each, and how many pixels are off by a tenth: {}.", seconds, finding);
  write_csv(easel.file("history.csv"), table);
  Page page("From Whitted to photon maps", "One room with a lamp, a mirror ball and a ball of glass, by each method of the history, each with the same time.");
  page.pictures(pictures);
  page.heading("What each has wrong");
  page.pictures(errors);
  page.text("Error is |x − r|, black for none, white for 0.5 and more, r the picture below. It has two kinds: noise, which more time removes, and light that a method does not follow or blurs, which time does not. "
            "The mean of the light tells them apart: noise does not move it. relMSE is a mean of squares, in which one bright pixel outweighs a thousand dark ones; how many pixels are off by a tenth is about what an eye would say.");
  page.pictures({{easel.file("history-reference.png"), "the reference"}});
  page.heading("What was measured");
  page.table(table);
  page.text(finding);
  page.text(fmt::format("Seconds are of rendering alone, kernels compiled and warm. The reference is `{}` with {} s and another seed, whose disks have become small by then; what noise and blur it has is in each figure.", reference_by, show_number(easel.size(10 * seconds, 0.5), 2)));
  page.command(fmt::format("sunstone render scenes/{} --integrator bdpt --size {}x{} --filter box --max-depth {} --time {} -o bdpt.png", lamp_scene, side, side, deepest, seconds));
  page.write(easel.file("history.html"));
  return finding;
}

}  // namespace sunstone
