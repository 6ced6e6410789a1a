// SPDX-License-Identifier: Apache-2.0
// The path from l1 to l2: light that reaches a matt surface by way of another. Whitted's rays cannot find it [Whitted80].
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

// scenes/mirror-lamp: a lamp that shines up at a mirror over a matt floor. Its image in the mirror is a lamp at this height that shines down.
constexpr double lamp_half = 0.4, lamp_height = 0.8, mirror_height = 2.5, image_height = 2 * mirror_height - lamp_height, lamp_radiance = 10, floor_albedo = 0.7;

// Irradiance over radiance at (x, z) of the floor under a rectangle parallel to it: four corners, each the form factor of a rectangle with a corner above.
double irradiance_per_radiance(double x, double z) {
  const auto corner = [](double a, double b) {
    a /= image_height, b /= image_height;
    const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / 2;
  };
  const double x0 = -lamp_half - x, x1 = lamp_half - x, z0 = -lamp_half - z, z1 = lamp_half - z;
  return corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0);
}

// Where the ray through a pixel's centre meets the floor, y = 0.
void floor_point(const kernel::Camera &camera, int width, int height, int pixel_x, int pixel_y, double &x, double &z) {
  const double sx = 2 * (pixel_x + 0.5) / width - 1, sy = 1 - 2 * (pixel_y + 0.5) / height;
  double direction[3];
  for (int c = 0; c < 3; c++) direction[c] = static_cast<double>(camera.forward[c]) + sx * static_cast<double>(camera.right[c]) + sy * static_cast<double>(camera.up[c]);
  const double t = -static_cast<double>(camera.position[1]) / direction[1];
  x = static_cast<double>(camera.position[0]) + t * direction[0];
  z = static_cast<double>(camera.position[2]) + t * direction[2];
}

// Of the light that surfaces send to the camera, what was scattered more than once; lights that are seen themselves are left out.
double missed_share(const Film &film, unsigned deepest) { return mean_luminance(beauty_of(bounces_of(film, 2, deepest))) / mean_luminance(beauty_of(bounces_of(film, 1, deepest))); }

// Pixels that direct light leaves black and further bounces light.
double black_share(const Film &film, unsigned deepest) {
  const std::vector<float> direct = film_beauty(bounces_of(film, 0, 1)), all = film_beauty(bounces_of(film, 0, deepest));
  std::size_t black = 0;
  for (std::size_t i = 0; i + 2 < all.size(); i += 3) black += direct[i] + direct[i + 1] + direct[i + 2] == 0 && all[i] + all[i + 1] + all[i + 2] > 0;
  return static_cast<double>(black) / static_cast<double>(film.pixels());
}

}  // namespace

std::string draw_l1_l2(Easel &easel) {
  constexpr unsigned deepest = 8;
  const int width = easel.size(240, 24), height = easel.size(160, 16);
  const std::uint64_t samples = easel.size<std::uint64_t>(1024, 16);
  const Shot mirror{"mirror-lamp/mirror-lamp.gltf", "", figure_settings(width, height, "path", deepest)};
  auto renderer = easel.studio.renderer(mirror);
  easel.studio.piece(0.5, "a lamp under a mirror");
  easel.studio.render(*renderer, {0, samples});
  const Film under = renderer->film();
  const Shot room{"cornell/cornell.gltf", "", figure_settings(height, height, "path", deepest)};
  renderer = easel.studio.renderer(room);
  easel.studio.piece(0.5, "the Cornell box");
  easel.studio.render(*renderer, {0, samples});
  const Film cornell = renderer->film();

  // Against the closed form, on a patch of floor in front that nothing shades.
  const kernel::Camera &camera = easel.studio.scene(mirror).camera;
  const FilmLayer &twice = *under.find("bounce.2");
  double measured = 0, exact = 0, count = 0;
  for (int y = height * 13 / 16; y < height * 15 / 16; y++)
    for (int x = width * 3 / 8; x < width * 5 / 8; x++, count++) {
      double at_x, at_z;
      floor_point(camera, width, height, x, y, at_x, at_z);
      measured += film_value(under, twice, static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x), 1);
      exact += floor_albedo * lamp_radiance * irradiance_per_radiance(at_x, at_z) / std::numbers::pi;
    }
  measured /= count, exact /= count;

  Table table{{"scene", "% lit directly", "% by way of l1 to l2", "% of pixels black without it"}, {}};
  const double under_share = missed_share(under, deepest), cornell_share = missed_share(cornell, deepest);
  table.rows.push_back({"lamp under a mirror", fmt::format("{:.2f}", 100 * (1 - under_share)), fmt::format("{:.2f}", 100 * under_share), fmt::format("{:.1f}", 100 * black_share(under, deepest))});
  table.rows.push_back({"Cornell box", fmt::format("{:.2f}", 100 * (1 - cornell_share)), fmt::format("{:.2f}", 100 * cornell_share), fmt::format("{:.1f}", 100 * black_share(cornell, deepest))});
  write_csv(easel.file("l1-l2.csv"), table);
  const std::string finding = fmt::format("Of the light that surfaces send to the camera, {:.1f} % came by way of another surface where a lamp shines up at a mirror, and {:.1f} % in the Cornell box; Whitted's rays find none of it. "
                                          "On the floor the reflected light is {:.4f}, where the closed form says {:.4f} ({:+.2f} %).", 100 * under_share, 100 * cornell_share, measured, exact, 100 * (measured / exact - 1));

  const auto row = [&](const Film &film, const char *name, float exposure) {
    std::vector<Picture> pictures;
    const auto keep = [&](const char *part, unsigned first, unsigned last, const char *caption) {
      const std::filesystem::path file = easel.file(fmt::format("l1-l2-{}-{}.png", name, part));
      write_png(file, bounces_of(film, first, last), exposure);
      pictures.push_back({file, caption});
    };
    keep("whitted", 0, 1, "What Whitted's rays find: lights, and what they light directly.");
    keep("missing", 2, deepest, "What they cannot: light that came by way of another surface.");
    keep("all", 0, deepest, "Both.");
    return pictures;
  };
  Page page("The path from l1 to l2", "Light that Whitted's ray tracing cannot find.");
  page.text("Whitted follows rays from the eye: at mirrors and glass they go on, at a matt surface they stop, and a shadow ray asks whether each light is seen. So a path has the form L D S* E: from a light to one matt surface, and by mirrors to the eye. "
            "Light that leaves a surface along l1 and reaches the matt surface that the eye sees along l2 has no ray that looks for it.");
  page.heading("By a mirror: L S D E");
  page.pictures(row(under, "mirror", 1));
  page.text("The lamp shines up, its housing shades the floor, a mirror over it sends the light down. A shadow ray from the floor to the lamp meets the housing; from a matt floor Whitted sends no ray up into the mirror. The floor stays black.");
  page.text(fmt::format("The floor's light is known: the lamp's image stands in the mirror at {:.1f} m and shines down, so two scatterings (mirror, floor) give albedo × radiance × form factor. Over a patch of {:.0f} pixels in front: {:.5f} by the formula, "
                        "{:.5f} rendered, {:+.2f} % apart.", image_height, count, exact, measured, 100 * (measured / exact - 1)));
  page.heading("By matt surfaces: L D D E");
  page.pictures(row(cornell, "cornell", 0));
  page.text(finding + fmt::format(" In the Cornell box {:.1f} % of the pixels have no direct light at all; the ceiling is among them, as the lamp hangs in it. Whitted put an ambient term there, a constant; here it is light with colour and direction.", 100 * black_share(cornell, deepest)));
  page.text("There is no surface but matt ones in the Cornell box and nothing but a mirror and matt ones that the eye sees directly in the other, so what has been scattered once or less is what Whitted's rays find, and the layers of bounces divide the light exactly.");
  page.table(table);
  page.command(fmt::format("sunstone render scenes/mirror-lamp/mirror-lamp.gltf --size {}x{} --filter box --max-depth 8 --spp {} --exposure 1 -o mirror.png", width, height, samples));
  page.write(easel.file("l1-l2.html"));
  return finding;
}

}  // namespace sunstone
