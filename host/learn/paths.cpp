// SPDX-License-Identifier: Apache-2.0
// The paths of one pixel: drawn over the picture, and vertex by vertex in a table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"
#include "learn/trace.h"

namespace sunstone {

namespace {

using Json = nlohmann::ordered_json;
using Kind = TracedVertex::Kind;
using Leaves = TracedVertex::Leaves;

const char *kind_name(const TracedVertex &v) { return v.kind == Kind::surface ? "surface" : v.kind == Kind::emitter ? "emitter" : "escaped"; }
const char *leaves_name(const TracedVertex &v) {
  return v.leaves == Leaves::ended ? "ended" : v.leaves == Leaves::scattered ? "scattered" : v.leaves == Leaves::delta ? "delta" : "straight";
}
bool dark(const Triple &t) { return t[0] == 0 && t[1] == 0 && t[2] == 0; }
std::string show(const Triple &t) { return dark(t) ? "0" : show_number(t[0], 3) + ", " + show_number(t[1], 3) + ", " + show_number(t[2], 3); }

Json json_of(const TracedPath &path) {
  Json vertices = Json::array();
  for (const TracedVertex &v : path.vertices) {
    Json shadows = Json::array();
    for (const TracedShadowRay &s : v.shadow_rays) shadows.push_back({{"origin", s.from}, {s.far ? "direction" : "target", s.to}, {"contribution_if_visible", s.worth}});
    Json j = {{"type", kind_name(v)}, {"depth", v.depth}};
    if (v.kind == Kind::escaped) j["direction"] = v.position;
    else j.update({{"position", v.position}, {"normal", v.normal}, {"material", v.material}, {"instance", v.instance}, {"primitive", v.primitive}});
    j.update({{"arriving", {{"pdf_solid_angle", v.pdf_arriving}, {"delta", v.pdf_arriving == 0}, {"throughput", v.throughput}}},
              {"emission", v.emission},
              {"shadow_rays", shadows},
              {"direct", v.direct},
              {"leaving", {{"as", leaves_name(v)}, {"pdf_solid_angle", v.pdf_leaving}, {"throughput", v.throughput_after}}}});
    vertices.push_back(j);
  }
  return {{"sample", path.sample}, {"camera", path.camera}, {"ended", path.ended}, {"contribution", path.contribution}, {"vertices", vertices}};
}

Table table_of(const TracedPath &path) {
  Table table{{"vertex", "type", "depth", "position", "pdf (1/sr)", "throughput", "shines", "shadow rays", "from them", "goes on", "pdf next", "throughput next"}, {}};
  for (std::size_t i = 0; i < path.vertices.size(); i++) {
    const TracedVertex &v = path.vertices[i];
    table.rows.push_back({std::to_string(i + 1), v.kind == Kind::escaped ? "escaped" : fmt::format("{} `{}`", kind_name(v), v.material), std::to_string(v.depth),
                          v.kind == Kind::escaped ? "direction " + show(v.position) : show(v.position), v.pdf_arriving == 0 ? (i ? "delta" : "camera") : show_number(v.pdf_arriving), show(v.throughput), show(v.emission),
                          v.shadow_rays.empty() ? "–" : fmt::format("{}{}", v.shadow_rays.size(), dark(v.direct) ? ", blocked" : ""), show(v.direct), leaves_name(v),
                          v.leaves == Leaves::scattered ? show_number(v.pdf_leaving) : v.leaves == Leaves::ended ? "–" : "delta", v.leaves == Leaves::ended ? "–" : show(v.throughput_after)});
  }
  return table;
}

// Lines over a picture of this size, as the camera sees them.
class Overlay {
 public:
  Overlay(const kernel::Camera &camera, int width, int height) : camera_(camera), width_(width), height_(height) {}

  std::string segment(Triple a, Triple b, const char *name, std::size_t colour) const {
    // What is behind the camera has no place in the picture: the line is cut a little before it.
    const double near = 1e-3 * std::max(1e-6, std::max(ahead(a), ahead(b)));
    if (camera_.kind == SUN_CAMERA_PERSPECTIVE) {
      if (ahead(a) < near && ahead(b) < near) return "";
      if (ahead(a) < near) a = between(b, a, near);
      if (ahead(b) < near) b = between(a, b, near);
    }
    double x0, y0, x1, y1;
    if (!project(camera_, width_, height_, a, x0, y0) || !project(camera_, width_, height_, b, x1, y1)) return "";
    return fmt::format("<path class='{} k{}' d='M{:.2f} {:.2f}L{:.2f} {:.2f}'/>", name, colour % 6, x0, y0, x1, y1);
  }

  std::string mark(const TracedVertex &v, std::size_t number, std::size_t colour, bool numbered) const {
    double x, y;
    if (v.kind == Kind::escaped || !project(camera_, width_, height_, v.position, x, y)) return "";
    const double r = width_ / 110.0;
    std::string svg = v.kind == Kind::emitter ? fmt::format("<rect class='light' x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}'/>", x - r, y - r, 2 * r, 2 * r)
                                              : fmt::format("<circle class='{} k{}' cx='{:.2f}' cy='{:.2f}' r='{:.2f}'/>", v.leaves == Leaves::delta || v.leaves == Leaves::straight ? "hollow" : "full", colour % 6, x, y, r);
    if (numbered) svg += fmt::format("<text x='{:.2f}' y='{:.2f}' font-size='{:.1f}'>{}</text>", x + 1.4 * r, y - 0.6 * r, 3.2 * r, number);
    return svg;
  }

  std::string path(const TracedPath &p, std::size_t colour, double reach, bool detailed) const {
    std::string svg, marks;
    Triple at = p.camera;
    for (std::size_t i = 0; i < p.vertices.size(); i++) {
      const TracedVertex &v = p.vertices[i];
      Triple to = v.position;
      if (v.kind == Kind::escaped)
        for (std::size_t c = 0; c < 3; c++) to[c] = v.from[c] + v.position[c] * reach;
      if (i > 0) svg += segment(at, to, "ray", colour);
      for (const TracedShadowRay &s : v.shadow_rays) {
        if (!detailed) break;
        Triple target = s.to;
        if (s.far)
          for (std::size_t c = 0; c < 3; c++) target[c] = s.from[c] + s.to[c] * reach;
        svg += segment(s.from, target, dark(v.direct) ? "blocked" : "seen", colour);
      }
      marks += mark(v, i + 1, colour, detailed);
      at = to;
    }
    return svg + marks;
  }

  // With the picture in it, or (later on the same page) with a reference to it.
  std::string drawing(const std::string &image, const std::string &lines, int pixel_x, int pixel_y) const {
    constexpr const char *style =
        "<style>.trace{background:#000;max-width:40rem;width:100%}.trace path{fill:none;vector-effect:non-scaling-stroke}.trace .ray{stroke-width:2}"
        ".trace .light{fill:#ffe14d;stroke:#000;stroke-width:.4}.trace .full{stroke:#000;stroke-width:.4}.trace .hollow{fill:#0004;stroke-width:.8}"
        ".trace text{fill:#fff;stroke:#000;stroke-width:.8;paint-order:stroke;font-family:system-ui,sans-serif}.trace .pixel{fill:none;stroke:#fff;stroke-width:.5}"
        ".trace .k0{stroke:#56b4e9}.trace .k1{stroke:#ff8c42}.trace .k2{stroke:#3fd1a4}.trace .k3{stroke:#e79ac9}.trace .k4{stroke:#f0c04a}.trace .k5{stroke:#ddd}"
        ".trace .full.k0{fill:#56b4e9}.trace .full.k1{fill:#ff8c42}.trace .full.k2{fill:#3fd1a4}.trace .full.k3{fill:#e79ac9}.trace .full.k4{fill:#f0c04a}.trace .full.k5{fill:#ddd}.trace circle.full{stroke:#000}.trace .seen{stroke:#ffe14d;stroke-width:1.5;stroke-dasharray:5 3}.trace .blocked{stroke:#ff4d4d;stroke-width:1.5;stroke-dasharray:2 4}</style>";
    return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' class='trace' viewBox='0 0 {} {}' role='img' aria-label='paths of a pixel'>{}{}{}<rect class='pixel' x='{}' y='{}' width='1' height='1'/></svg>", width_, height_,
                       style, image, lines, pixel_x, pixel_y);
  }

 private:
  double ahead(const Triple &p) const {
    double sum = 0;
    for (std::size_t c = 0; c < 3; c++) sum += (p[c] - static_cast<double>(camera_.position[c])) * static_cast<double>(camera_.forward[c]);
    return sum;
  }
  // The point from `front` towards `behind` that is `near` ahead of the camera.
  Triple between(const Triple &front, const Triple &behind, double near) const {
    const double f = (ahead(front) - near) / (ahead(front) - ahead(behind));
    Triple p;
    for (std::size_t c = 0; c < 3; c++) p[c] = front[c] + (behind[c] - front[c]) * f;
    return p;
  }
  kernel::Camera camera_;
  int width_, height_;
};

// What the renderer itself makes of the same samples: the same integers, or the page would tell of other paths than those of the picture.
void check_against_render(Easel &easel, Shot shot, int x, int y, SampleRange samples, const TracedPixel &traced) {
  shot.settings.x0 = x, shot.settings.y0 = y, shot.settings.x1 = x + 1, shot.settings.y1 = y + 1;
  shot.settings.layers = {};
  const auto renderer = easel.studio.renderer(shot);
  easel.studio.render(*renderer, samples);
  std::vector<std::int64_t> film;
  for (const FilmLayer &layer : renderer->film().layers) film.insert(film.end(), layer.values.begin(), layer.values.end());
  if (film != traced.film) throw Error("learn paths", "the paths that were traced do not add up to what the renderer makes of the same samples", "this is a defect of sunstone or of the device's driver: sunstone verify tells which");
}

}  // namespace

std::string draw_paths(Easel &easel) {
  Shot shot;
  int x = 0, y = 0;
  if (easel.asked) {
    shot = easel.asked->shot, x = easel.asked->x, y = easel.asked->y;
  } else {
    const int side = easel.size(256, 32);
    shot = {"cornell/cornell.gltf", "", figure_settings(side, side, "path", 8)};
    x = side * 3 / 8, y = side * 29 / 32;  // on the floor
  }
  const SampleRange samples = easel.asked ? easel.asked->samples : SampleRange{0, 8};
  const int width = shot.settings.width, height = shot.settings.height;
  shot.settings.layers = {};
  const auto renderer = easel.studio.renderer(shot);
  easel.studio.piece(0.8, "the picture");
  easel.studio.render(*renderer, {0, easel.size<std::uint64_t>(64, 4)});
  const std::filesystem::path png = easel.file("paths.png");
  write_png(png, renderer->film());
  easel.studio.piece(0.2, "the paths, stage by stage");
  const TracedPixel traced = trace_pixel(easel.studio, shot, x, y, samples);
  check_against_render(easel, shot, x, y, samples, traced);

  const StudioScene &scene = easel.studio.scene(shot);
  const Overlay overlay(scene.camera, width, height);
  const glm::vec3 size = scene.flat.bounds.upper - scene.flat.bounds.lower;
  const double reach = 0.5 * static_cast<double>(glm::length(size));
  const std::string image = fmt::format("<image id='picture' href='{}' width='{}' height='{}' style='image-rendering:pixelated'/>", data_uri(png), width, height);
  std::string lines;
  for (std::size_t i = 0; i < traced.paths.size(); i++) lines += overlay.path(traced.paths[i], i, reach, traced.paths.size() == 1);
  const std::string drawing = overlay.drawing(image, lines, x, y);
  easel.keep_plot("paths.svg", drawing);

  Json all = Json::array();
  Table csv{{"sample", "vertex", "type", "material", "depth", "x", "y", "z", "pdf_solid_angle", "throughput_r", "throughput_g", "throughput_b", "emission_r", "emission_g", "emission_b", "direct_r", "direct_g", "direct_b", "leaves"}, {}};
  Triple sum{};
  std::size_t vertices = 0, lit = 0;
  for (const TracedPath &p : traced.paths) {
    all.push_back(json_of(p));
    lit += !dark(p.contribution);
    for (std::size_t c = 0; c < 3; c++) sum[c] += p.contribution[c] / static_cast<double>(traced.paths.size());
    for (std::size_t i = 0; i < p.vertices.size(); i++, vertices++) {
      const TracedVertex &v = p.vertices[i];
      std::vector<std::string> row = {std::to_string(p.sample), std::to_string(i + 1), kind_name(v), v.material, std::to_string(v.depth)};
      for (const double c : v.position) row.push_back(fmt::format("{}", c));
      row.push_back(fmt::format("{}", v.pdf_arriving));
      for (const Triple *t : {&v.throughput, &v.emission, &v.direct})
        for (const double c : *t) row.push_back(fmt::format("{}", c));
      row.push_back(leaves_name(v));
      csv.rows.push_back(row);
    }
  }
  write_csv(easel.file("paths.csv"), csv);
  const Json json = {{"scene", scene.line}, {"integrator", shot.settings.integrator}, {"size", {width, height}}, {"pixel", {x, y}}, {"mean", sum}, {"paths", all}};
  const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  write_file(easel.file("paths.json"), std::as_bytes(std::span(text)));

  const std::string finding = fmt::format("Pixel ({}, {}): {} paths of `{}` with {:.1f} vertices each, {} of which brought light; their mean is {}.", x, y, traced.paths.size(), shot.settings.integrator,
                                          static_cast<double>(vertices) / static_cast<double>(traced.paths.size()), lit, show(sum));
  // A scene of the program's own by its name there, wherever the program is.
  Page page(fmt::format("The paths of pixel ({}, {})", x, y), shot.scene.empty() ? scene.line : "scenes/" + shot.scene + scene.line.substr(scene.line.rfind(": ")));
  page.drawing(drawing, "Every path begins at the pixel with the white frame. Discs are hits, hollow ones where the path went on by mirror, smooth glass or straight; yellow squares are lights that a path ran into; a line without an end left the scene.");
  page.text(finding + " Read off the renderer's own stages, run one at a time on a pool with one path: what is below are the numbers that the picture is made of, and their sum is the renderer's own integers for these samples.");
  page.text("`pdf` is the density of the direction that led to a vertex, per steradian, `delta` where a mirror or smooth glass left no choice. `throughput` is what light arriving there is worth at the camera. `shines` is what the vertex "
            "added by itself, weighted as the integrator weighs; `from them` what its shadow rays brought.");
  for (std::size_t i = 0; i < traced.paths.size(); i++) {
    const TracedPath &p = traced.paths[i];
    page.heading(fmt::format("Sample {}: {} vertices, ended: {}, contributes {}", p.sample, p.vertices.size(), p.ended, show(p.contribution)));
    page.drawing(overlay.drawing("<use href='#picture'/>", overlay.path(p, i, reach, true), x, y), "Dashed: shadow rays, yellow where light came, red where something stood between.");
    page.table(table_of(p));
  }
  page.command(easel.asked ? easel.asked->command : fmt::format("sunstone learn paths scenes/cornell/cornell.gltf --size {}x{} --filter box --max-depth 8 --pixel {},{}", width, height, x, y));
  page.write(easel.file("paths.html"));
  return finding;
}

}  // namespace sunstone
