// SPDX-License-Identifier: Apache-2.0
#include "learn/trace.h"

#include <bit>
#include <cmath>

#include "base/error.h"
#include "shared/path_words.h"

namespace sunstone {

namespace {

constexpr unsigned pool = 16;  // a block of 4 x 4 pixels, of which the window holds one
constexpr float far = 1.0e37f;  // t_max of a shadow ray to an environment is beyond

Triple add(const Triple &a, const Triple &b, double scale = 1) { return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]}; }
double dot(const Triple &a, const Triple &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple cross(const Triple &a, const Triple &b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
Triple triple(const float *values) { return {values[0], values[1], values[2]}; }

// What the film holds of the pixel, both halves of the beauty together.
Triple light_of(const std::vector<std::int64_t> &film) {
  Triple light{};
  for (std::size_t half = 0; half < SUN_LAYER_FIRST_OPTIONAL; half++)
    for (std::size_t channel = 0; channel < SUN_FILM_CHANNELS; channel++) {
      const std::size_t at = (half * SUN_FILM_CHANNELS + channel) * SUN_FILM_BINS;
      light[channel] += film_number(film[at], film[at + 1]);
    }
  return light;
}

// A path's record in a copy of the pool.
class PathRecord {
 public:
  PathRecord(const StageState &state, unsigned slot, bool columns) : state_(state), slot_(slot), columns_(columns) {}
  kernel::uint word(unsigned field) const { return state_.paths[columns_ ? field * pool + slot_ : slot_ * kernel::SUN_PATH_WORDS + field]; }
  double number(unsigned field) const { return static_cast<double>(std::bit_cast<float>(word(field))); }
  Triple three(unsigned field) const { return {number(field), number(field + 1), number(field + 2)}; }

 private:
  const StageState &state_;
  unsigned slot_;
  bool columns_;
};

// The true normal of a triangle's front in world space, not of unit length.
Triple front_normal(const FlatScene &flat, unsigned instance, unsigned primitive) {
  Triple corners[3];
  const kernel::Instance &placed = flat.instances.at(instance);
  for (int i = 0; i < 3; i++) {
    const float *p = flat.vertices.at(flat.triangles.at(primitive).vertex[i]).position;
    for (std::size_t row = 0; row < 3; row++) {
      const float *m = placed.to_world + row * 4;
      corners[i][row] = static_cast<double>(m[0]) * p[0] + static_cast<double>(m[1]) * p[1] + static_cast<double>(m[2]) * p[2] + m[3];
    }
  }
  Triple normal = cross(add(corners[1], corners[0], -1), add(corners[2], corners[0], -1));
  if (placed.flags & SUN_INSTANCE_MIRRORED)
    for (double &c : normal) c = -c;
  return normal;
}

class Tracer {
 public:
  Tracer(const StudioScene &scene, Renderer &renderer, std::uint64_t sample, bool columns) : scene_(scene), probe_(renderer.probe({sample, sample + 1})), columns_(columns) { path_.sample = sample; }
  TracedPath trace();
  std::vector<std::int64_t> film() const { return probe_.film(); }

 private:
  void after(Stage stage, const StageState &state);
  void hit(const StageState &state);
  void shaded(const StageState &state);

  const StudioScene &scene_;
  StageProbe probe_;
  bool columns_;
  TracedPath path_;
  TracedVertex vertex_;
  bool begun_ = false, alive_ = false, found_ = false;
  unsigned slot_ = 0;
  Triple light_{};
};

void Tracer::hit(const StageState &state) {
  const PathRecord record(state, slot_, columns_);
  const kernel::Hit &h = state.hits[slot_];
  vertex_ = {};
  vertex_.depth = state.status[slot_] & SUN_STATUS_DEPTH;
  vertex_.from = record.three(kernel::SUN_PATH_origin_x);
  vertex_.throughput = vertex_.throughput_after = record.three(kernel::SUN_PATH_throughput_r);
  vertex_.pdf_arriving = record.number(kernel::SUN_PATH_pdf_solid_angle);
  const Triple direction = record.three(kernel::SUN_PATH_direction_x);
  if (path_.vertices.empty()) path_.camera = vertex_.from;
  found_ = h.instance != SUN_NONE;
  if (!found_) {
    vertex_.kind = TracedVertex::Kind::escaped;
    vertex_.position = direction;
    return;
  }
  vertex_.position = add(vertex_.from, direction, static_cast<double>(h.t));
  vertex_.instance = h.instance;
  vertex_.primitive = h.primitive;
  vertex_.normal = front_normal(scene_.flat, h.instance, h.primitive);
  const double length = std::sqrt(dot(vertex_.normal, vertex_.normal)), facing = dot(vertex_.normal, direction);
  for (double &c : vertex_.normal) c *= (facing > 0 ? -1 : 1) / (length > 0 ? length : 1);
  const kernel::uint number = scene_.flat.triangles.at(h.primitive).material;
  const kernel::Material &material = scene_.flat.materials.at(number);
  vertex_.material = number < scene_.material_names.size() ? scene_.material_names[number] : "";
  const bool seen = facing < 0 || (material.flags & SUN_MATERIAL_DOUBLE_SIDED);
  if ((material.flags & SUN_MATERIAL_EMISSIVE) && seen) vertex_.kind = TracedVertex::Kind::emitter;
}

void Tracer::shaded(const StageState &state) {
  const PathRecord record(state, slot_, columns_);
  const kernel::uint word = state.status[slot_];
  alive_ = word & SUN_STATUS_ALIVE;
  vertex_.throughput_after = record.three(kernel::SUN_PATH_throughput_r);
  if (alive_) {
    const bool straight = found_ && (word & SUN_STATUS_DEPTH) == vertex_.depth;
    vertex_.pdf_leaving = record.number(kernel::SUN_PATH_pdf_solid_angle);
    vertex_.leaves = straight ? TracedVertex::Leaves::straight : vertex_.pdf_leaving > 0 ? TracedVertex::Leaves::scattered : TracedVertex::Leaves::delta;
  }
  const unsigned rays = static_cast<unsigned>(state.shadow_rays.size()) / pool;
  for (unsigned number = 0; (word & SUN_STATUS_SHADOW) && number < rays; number++) {
    const kernel::ShadowRay &ray = state.shadow_rays[number * pool + slot_];
    if (ray.t_max < 0) continue;
    TracedShadowRay shadow;
    shadow.far = ray.t_max > far;
    shadow.from = triple(ray.origin);
    shadow.to = shadow.far ? triple(ray.direction) : add(shadow.from, triple(ray.direction));
    shadow.worth = triple(ray.contribution);
    vertex_.shadow_rays.push_back(shadow);
  }
}

void Tracer::after(Stage stage, const StageState &state) {
  const Triple light = light_of(probe_.film()), added = add(light, light_, -1);
  light_ = light;
  if (stage == Stage::generate && !begun_) {
    for (unsigned slot = 0; slot < pool; slot++)
      if (state.status[slot] & SUN_STATUS_ALIVE) slot_ = slot, begun_ = alive_ = true;
    return;
  }
  if (!alive_ && stage != Stage::gather_shadow_rays && stage != Stage::occlude) return;
  if (stage == Stage::intersect) hit(state);
  if (stage == Stage::shade) {
    shaded(state);
    vertex_.emission = added;
  }
  if (stage == Stage::occlude) vertex_.direct = add(vertex_.direct, added);
  if (stage == Stage::roulette) {
    alive_ = state.status[slot_] & SUN_STATUS_ALIVE;
    if (alive_) vertex_.throughput_after = PathRecord(state, slot_, columns_).three(kernel::SUN_PATH_throughput_r);
    else vertex_.leaves = TracedVertex::Leaves::ended;
  }
}

TracedPath Tracer::trace() {
  static const char *const reasons[SUN_ENDED_COUNT] = {"light", "depth", "escaped", "absorbed"};
  do {
    kernel::uint word = 0;
    for (const Stage stage : probe_.walk()) {
      probe_.run(stage);
      const StageState state = probe_.save();
      after(stage, state);
      if (begun_) word = state.status[slot_];
    }
    if (!begun_) throw Error("learn paths", "the device began no path of this pixel", "sunstone verify tells whether its driver is to be trusted");
    path_.vertices.push_back(vertex_);
    if (!alive_) path_.ended = reasons[(word >> SUN_STATUS_ENDED_SHIFT) & (SUN_ENDED_COUNT - 1)];
  } while (alive_);
  path_.contribution = light_;
  return path_;
}

}  // namespace

TracedPixel trace_pixel(Studio &studio, Shot shot, int x, int y, SampleRange samples) {
  shot.settings.x0 = x;
  shot.settings.y0 = y;
  shot.settings.x1 = x + 1;
  shot.settings.y1 = y + 1;
  shot.settings.layers = {};
  shot.settings.transparent_background = false;
  const auto renderer = studio.renderer(shot, pool);
  TracedPixel pixel;
  for (std::uint64_t sample = samples.first; sample < samples.last; sample++) {
    Tracer tracer(studio.scene(shot), *renderer, sample, studio.columns());
    pixel.paths.push_back(tracer.trace());
    const std::vector<std::int64_t> film = tracer.film();
    pixel.film.resize(film.size());
    for (std::size_t i = 0; i < film.size(); i++) pixel.film[i] += film[i];
  }
  return pixel;
}

bool project(const kernel::Camera &camera, int width, int height, const Triple &point, double &x, double &y) {
  const Triple right = triple(camera.right), up = triple(camera.up), forward = triple(camera.forward), to = add(point, triple(camera.position), -1);
  const double along = dot(to, forward);
  const bool flat = camera.kind == SUN_CAMERA_ORTHOGRAPHIC;
  if (!flat && !(along > 0)) return false;
  const double scale = flat ? 1 : along;
  x = (dot(to, right) / (dot(right, right) * scale) + 1) / 2 * width;
  y = (1 - dot(to, up) / (dot(up, up) * scale)) / 2 * height;
  return true;
}

}  // namespace sunstone
