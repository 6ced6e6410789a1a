// SPDX-License-Identifier: Apache-2.0
#include "pipeline/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "pipeline/light_pass.h"
#include "shared/bidirectional.h"

namespace sunstone {

namespace {

constexpr std::uint64_t max_paths_of_a_launch = std::uint64_t(1) << 31;
constexpr int steps_between_looks = 8;  // of the whole walk, before the host reads how far it is

struct Tile {
  int x0, y0, width, height;
  std::uint64_t paths_per_sample() const { return static_cast<std::uint64_t>((width + 3) / 4) * static_cast<std::uint64_t>((height + 3) / 4) * 16; }
};

// The window in bands of rows, so that no film on the device is larger than `budget` bytes.
std::vector<Tile> split(const RenderSettings &s, std::size_t bytes_a_pixel, std::size_t budget) {
  const int width = s.x1 - s.x0, height = s.y1 - s.y0;
  const std::size_t row = bytes_a_pixel * static_cast<std::size_t>(width);
  if (row * 4 > budget) throw Error("film", fmt::format("four rows of {} pixels need {} bytes on the device, more than it allows", width, row * 4));
  int rows = static_cast<int>(std::min<std::size_t>(budget / row, static_cast<std::size_t>(height)));
  if (rows < height) rows = rows / 4 * 4;
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += rows) tiles.push_back({s.x0, s.y0 + y, width, std::min(rows, height - y)});
  return tiles;
}

unsigned choose_pool(const DeviceInfo &info, const Tuning &tuning, std::uint64_t paths, unsigned light_samples, unsigned branch_records, unsigned light_vertices, bool mapped) {
  // On CPUs the pool stays in the caches, light vertices included; but a pass that ends with its pool wants a large one.
  unsigned pool = tuning.pool ? tuning.pool : info.gpu ? 1u << 20 : mapped ? 1u << 13 : light_vertices ? 1u << 12 : 1u << 14;
  constexpr unsigned most_shadow_rays = 1u << 22;  // 256 MiB of them
  if (!tuning.pool) pool = static_cast<unsigned>(std::min<std::size_t>(pool, std::min<std::size_t>(most_shadow_rays, info.max_allocation / sizeof(kernel::ShadowRay)) / light_samples));
  constexpr std::size_t most_branch_bytes = std::size_t(1) << 28;
  if (!tuning.pool && branch_records) pool = static_cast<unsigned>(std::min<std::size_t>(pool, std::min(most_branch_bytes, info.max_allocation) / (std::size_t(64) * branch_records)));
  constexpr std::size_t most_light_vertices = std::size_t(1) << 28;  // bytes
  if (!tuning.pool && light_vertices)
    pool = static_cast<unsigned>(std::min<std::size_t>(pool, std::min(most_light_vertices, info.max_allocation) / (std::size_t(SUN_LIGHT_VERTEX_RECORDS) * 64 * light_vertices)));
  if (!tuning.pool && paths < pool) pool = static_cast<unsigned>(std::max<std::uint64_t>(paths, 16));
  return std::max(16u, (pool + 15) / 16 * 16);
}

}  // namespace

struct Renderer::State {
  Device device;
  const Programs &programs;
  const Plan &plan;
  RenderSettings settings;
  kernel::Frame frame{};
  Film film;
  Counters counters;
  DeviceScene scene;
  std::vector<Tile> tiles;
  std::unique_ptr<Pool> pool;
  Buffer<kernel::Frame> device_frame;
  Buffer<std::int64_t> device_film;
  std::vector<Stage> walk;      // the plan's, without stages that nothing asks for here
  std::unique_ptr<LightPass> light;  // where the plan has one

  State(const Device &d, const Programs &p, const Plan &pl, const RenderSettings &s) : device(d), programs(p), plan(pl), settings(s) {}
  void name_layers();
  void place_tile(const Tile &tile);
  void begin_film(const Tile &tile);
  // A pass for each sample, so that a launch has one sample alone.
  bool passes_each_sample() const { return light && !plan.map_once; }
  std::uint64_t render_launch(StageRunner &runner, std::uint64_t first, std::uint64_t count, std::uint64_t before, std::uint64_t wanted,
                              const std::function<bool(const RenderProgress &)> &progress);
  std::uint64_t render_tile(const Tile &tile, SampleRange range, std::uint64_t &begun, std::uint64_t wanted,
                            const std::function<bool(const RenderProgress &)> &progress);
  void add_tile(const Tile &tile);
  double pixel_seen();
};

void Renderer::State::name_layers() {
  const auto add = [&](const std::string &name) {
    film.layers.push_back({name, std::vector<std::int64_t>(film.pixels() * SUN_FILM_CHANNELS * SUN_FILM_BINS)});
    return static_cast<kernel::uint>(film.layers.size() - 1);
  };
  const auto wanted = [&](bool on, const std::string &name) { return on ? add(name) : SUN_NONE; };
  add("beauty.even");
  add("beauty.odd");
  const LayerChoice &choice = settings.layers;
  frame.layer_bounce = SUN_NONE;
  if (choice.bounces) {
    frame.bounce_layers = settings.max_depth + 1;
    for (unsigned depth = 0; depth <= settings.max_depth; depth++) {
      const kernel::uint layer = add(fmt::format("bounce.{}", depth));
      if (depth == 0) frame.layer_bounce = layer;
    }
  }
  frame.layer_albedo = wanted(choice.albedo, "albedo");
  frame.layer_normal = wanted(choice.normal, "normal");
  frame.layer_depth = wanted(choice.depth, "Z");
  frame.layer_position = wanted(choice.position, "position");
  frame.layer_object = wanted(choice.object, "object_id");
  frame.layer_material = wanted(choice.material, "material_id");
  frame.layer_alpha = wanted(choice.alpha || settings.transparent_background, "alpha");
}

Renderer::Renderer(const Device &device, const Programs &programs, const FlatScene &scene, const kernel::Camera &camera, const RenderSettings &settings, const Tuning &tuning)
    : state_(std::make_unique<State>(device, programs, integrator(settings.integrator), settings)) {
  State &s = *state_;
  check_plan(s.plan);
  check_settings(s.plan, settings);
  s.film.picture_width = settings.width;
  s.film.picture_height = settings.height;
  s.film.x0 = settings.x0;
  s.film.y0 = settings.y0;
  s.film.x1 = settings.x1;
  s.film.y1 = settings.y1;
  s.film.scene_hash = scene.scene_hash.hex();
  s.name_layers();

  kernel::Frame &frame = s.frame;
  const FilterTable filter = make_filter_table(settings.filter);
  frame.camera = camera;
  frame.width = static_cast<kernel::uint>(settings.width);
  frame.height = static_cast<kernel::uint>(settings.height);
  frame.seed = settings.seed;
  frame.sampler = settings.independent ? SUN_SAMPLER_INDEPENDENT : SUN_SAMPLER_SOBOL;
  frame.max_depth = settings.max_depth;
  frame.roulette_depth = settings.roulette_depth;
  frame.filter_radius = settings.filter.radius;
  frame.filter_weight = filter.weight;
  frame.filter_negative_from = filter.negative_from;
  if (settings.transparent_background) frame.flags |= SUN_FRAME_TRANSPARENT;
  if (s.plan.direct) frame.flags |= SUN_FRAME_DIRECT;
  if (s.plan.weighted) frame.flags |= SUN_FRAME_WEIGHTED;
  if (s.plan.effects) frame.flags |= SUN_FRAME_EFFECTS;
  if (s.plan.one_time) frame.flags |= SUN_FRAME_ONE_TIME;
  if (s.plan.map_once) frame.flags |= SUN_FRAME_FINAL_GATHER;
  if (settings.nee_first) frame.flags |= SUN_FRAME_FIRST;
  if (settings.double_count) frame.flags |= SUN_FRAME_TWICE;
  if (settings.end_on_light) frame.flags |= SUN_FRAME_END_ON_LIGHT;
  frame.sampling = settings.sampling == Sampling::uniform ? SUN_SAMPLING_UNIFORM : settings.sampling == Sampling::cosine ? SUN_SAMPLING_COSINE : SUN_SAMPLING_BSDF;
  frame.light_samples = settings.light_samples;
  frame.indirect_samples = settings.indirect_samples;
  if (settings.balance) frame.flags |= SUN_FRAME_BALANCE;
  if (settings.unweighted) frame.flags |= SUN_FRAME_UNWEIGHTED;
  frame.strategy_s = settings.strategy_t ? settings.strategy_s : SUN_NONE;
  frame.strategy_t = settings.strategy_t ? settings.strategy_t : SUN_NONE;
  frame.absorption = settings.absorption;
  frame.cutoff = settings.cutoff;
  std::ranges::copy(settings.ambient, frame.ambient);
  s.scene = upload(device, scene, filter.inverse_cdf, frame);
  resolve_photons(s.plan, s.settings, frame);
  if (s.plan.bidirectional && !s.plan.light_walk.empty()) frame.flags |= SUN_FRAME_EYE_PASS;

  for (const Stage stage : s.plan.walk) {
    const bool layers = s.film.layers.size() > SUN_LAYER_FIRST_OPTIONAL + frame.bounce_layers, lit = frame.emitter_count > 0;
    const bool of_lights = stage == Stage::gather_shadow_rays || stage == Stage::occlude || stage == Stage::occlude_all;
    const bool of_photons = stage == Stage::gather || stage == Stage::gather_caustics;
    if (stage == Stage::first_hit ? layers : stage == Stage::branch ? branches(settings) : of_lights ? lit : of_photons ? lit && settings.max_depth > 0 : true) s.walk.push_back(stage);
  }

  const std::size_t bytes_a_pixel = s.film.layers.size() * SUN_FILM_CHANNELS * SUN_FILM_BINS * sizeof(std::int64_t);
  const std::size_t room = device.info().memory > device.allocated() ? (device.info().memory - device.allocated()) / 2 : 0;
  s.tiles = split(settings, bytes_a_pixel, std::min(device.info().max_allocation, room));
  if (branches(settings) && !programs.variant.branching) throw std::logic_error("programs without branches");
  if (scene.shape_count > 0 && !programs.variant.shapes) throw std::logic_error("programs without shapes");
  const unsigned branch_records = programs.variant.branching ? SUN_BRANCH_RECORDS(settings.max_depth) : 0;
  if (s.plan.bidirectional && s.tiles.size() > 1)
    throw Error("film", fmt::format("a picture of {}x{} does not fit on the device in one piece, and the light subpaths of --integrator {} may light any pixel", settings.width, settings.height, s.plan.name),
                "use a smaller --size, fewer layers of --aov, or another --device");
  if (scene.motion() > programs.variant.motion) throw std::logic_error("programs without motion");
  const bool mapped = !s.plan.light_walk.empty();
  if ((s.plan.bidirectional || mapped) && !programs.variant.bidirectional) throw std::logic_error("programs without light subpaths");
  if (programs.variant.light_map != mapped || programs.variant.photons != s.plan.photons) throw std::logic_error("programs of another integrator");
  // An eye vertex sends a shadow ray to an emitter and to each light vertex.
  const unsigned of_a_depth = SUN_LIGHT_VERTICES_A_DEPTH(scene.has_passable);
  const unsigned light_vertices = of_a_depth * (mapped ? std::max(1u, settings.max_depth) : s.plan.bidirectional ? std::max(2u, settings.max_depth) - 1 : 0), shadow_rays = s.plan.bidirectional ? light_vertices + 1 : settings.light_samples;
  frame.pool = choose_pool(device.info(), tuning, std::max<std::uint64_t>(s.tiles[0].paths_per_sample() * 16, frame.light_paths), shadow_rays, branch_records, light_vertices, mapped);
  if (static_cast<std::uint64_t>(frame.pool) * branch_records * 16 > std::numeric_limits<kernel::uint>::max())
    throw UsageError("--pool " + std::to_string(frame.pool), "with the branches of --max-depth " + std::to_string(settings.max_depth) + " has more words than 32 bits count", "use a smaller pool");
  if (static_cast<std::uint64_t>(frame.pool) * light_vertices * SUN_LIGHT_VERTEX_RECORDS * 16 > SUN_NONE)
    throw UsageError("--pool " + std::to_string(frame.pool), "has more light vertices than 32 bits count", "use a smaller pool, or a smaller --max-depth");
  s.pool = std::make_unique<Pool>(device, frame.pool, programs.variant.chunk, shadow_rays, branch_records, light_vertices);
  if (mapped) s.light = std::make_unique<LightPass>(device, programs, s.plan, s.settings, frame, s.device_frame);
  // The keys of a camera that moves stand behind the frame.
  const std::size_t key_bytes = scene.camera_keys.size() * sizeof(kernel::Camera);
  s.device_frame = Buffer<kernel::Frame>(device, 1 + (key_bytes + sizeof(kernel::Frame) - 1) / sizeof(kernel::Frame), "frame");
  if (key_bytes) {
    frame.flags |= SUN_FRAME_CAMERA_MOVES;
    s.device_frame.write(scene.camera_keys.data(), key_bytes, sizeof(kernel::Frame));
  }
  s.device_film = Buffer<std::int64_t>(
      device, s.film.layers.size() * static_cast<std::size_t>(s.tiles[0].width) * static_cast<std::size_t>(s.tiles[0].height) * SUN_FILM_CHANNELS * SUN_FILM_BINS, "film");
  if (mapped && !s.plan.photons && settings.radius == 0) bound_radius(s.settings, s.pixel_seen());
  s.film.settings = film_settings(s.settings, camera, scene.camera_keys);
}

Renderer::~Renderer() = default;

// The size of a pixel, in metres, at the median distance of what the camera rays of sample 0 hit: infinity where they hit nothing. Hits are the same on every device, and a
// median depends on no order.
double Renderer::State::pixel_seen() {
  place_tile(tiles[0]);
  frame.sample_first = 0;
  device_frame.upload(std::span(&frame, 1));
  StageRunner runner(programs, scene, *pool, device_frame, device_film);
  std::vector<float> distances;
  for (kernel::uint first = 0; first < frame.paths_per_sample; first += pool->slots) {
    pool->status.fill_zero();
    counters.begin(*pool, first, std::min(first + pool->slots, frame.paths_per_sample));
    for (const Stage stage : {Stage::gather_paths, Stage::emit, Stage::intersect}) runner.run(stage);
    const std::vector<kernel::Hit> hits = pool->hits.download();
    const std::vector<kernel::uint> status = pool->status.download();
    for (std::size_t slot = 0; slot < hits.size(); slot++)
      if ((status[slot] & SUN_STATUS_ALIVE) && hits[slot].instance != SUN_NONE) distances.push_back(hits[slot].t);
  }
  pool->status.fill_zero();
  if (distances.empty()) return std::numeric_limits<double>::infinity();
  const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, median);
  const float *up = frame.camera.up;
  const double half = std::sqrt(static_cast<double>(up[0]) * up[0] + static_cast<double>(up[1]) * up[1] + static_cast<double>(up[2]) * up[2]);
  return 2 * half / frame.height * (frame.camera.kind == SUN_CAMERA_ORTHOGRAPHIC ? 1.0 : static_cast<double>(*median));
}

// One launch of `count` samples from `first` on: steps until every path has ended. Returns how many samples were done.
std::uint64_t Renderer::State::render_launch(StageRunner &runner, std::uint64_t first, std::uint64_t count, std::uint64_t before, std::uint64_t wanted,
                                             const std::function<bool(const RenderProgress &)> &progress) {
  frame.sample_first = static_cast<kernel::uint>(first);
  device_frame.upload(std::span(&frame, 1));
  const std::uint64_t per_sample = frame.paths_per_sample;
  counters.begin(*pool, 0, static_cast<kernel::uint>(count * per_sample));
  bool stopping = false;
  for (;;) {
    for (int step = 0; step < (passes_each_sample() ? steps_in_a_pass : steps_between_looks); step++)
      for (const Stage stage : walk) runner.run(stage);
    counters.look(*pool);
    const std::uint64_t begun = counters.seen[SUN_COUNT_NEXT_PATH];
    if (!stopping && progress && !progress({before + begun, wanted})) {
      stopping = true;
      count = std::min(count, (begun + per_sample - 1) / per_sample);
      const kernel::uint paths = static_cast<kernel::uint>(count * per_sample);
      pool->counts.upload(std::span(&paths, 1), SUN_COUNT_PATHS);
    }
    if (counters.seen[SUN_COUNT_LIVE] == 0 && begun >= count * per_sample) break;
  }
  return count;
}

void Renderer::State::place_tile(const Tile &tile) {
  frame.tile_x0 = static_cast<kernel::uint>(tile.x0);
  frame.tile_y0 = static_cast<kernel::uint>(tile.y0);
  frame.tile_width = static_cast<kernel::uint>(tile.width);
  frame.tile_height = static_cast<kernel::uint>(tile.height);
  frame.paths_per_sample = static_cast<kernel::uint>(tile.paths_per_sample());
}

void Renderer::State::begin_film(const Tile &tile) {
  place_tile(tile);
  device_film.fill_zero();
  if (light) light->begin_film();
}

std::uint64_t Renderer::State::render_tile(const Tile &tile, SampleRange range, std::uint64_t &begun, std::uint64_t wanted,
                                           const std::function<bool(const RenderProgress &)> &progress) {
  begin_film(tile);
  StageRunner runner(programs, scene, *pool, device_frame, device_film);
  const std::uint64_t at_once = passes_each_sample() ? 1 : std::max<std::uint64_t>(1, max_paths_of_a_launch / tile.paths_per_sample());
  std::uint64_t done = range.first;
  bool go_on = true;
  const auto asked = [&](const RenderProgress &p) { return go_on = go_on && (!progress || progress(p)); };
  while (go_on && done < range.last) {
    const std::uint64_t count = std::min(at_once, range.last - done);
    if (light) light->look(runner, *pool, counters, done);
    const std::uint64_t finished = render_launch(runner, done, count, begun, wanted, asked);
    begun += finished * tile.paths_per_sample();
    done += finished;
    if (finished < count) break;
  }
  add_tile(tile);
  return done;
}

void Renderer::State::add_tile(const Tile &tile) {
  constexpr std::size_t values_a_pixel = SUN_FILM_CHANNELS * SUN_FILM_BINS;
  const std::size_t tile_values = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height) * values_a_pixel;
  const std::size_t at = static_cast<std::size_t>(tile.y0 - film.y0) * static_cast<std::size_t>(film.width()) * values_a_pixel;  // tiles are whole rows
  for (std::size_t layer = 0; layer < film.layers.size(); layer++) {
    const std::vector<std::int64_t> values = device_film.download(layer * tile_values, tile_values);
    std::int64_t *out = film.layers[layer].values.data() + at;
    for (std::size_t i = 0; i < tile_values; i++)
      out[i] = static_cast<std::int64_t>(static_cast<std::uint64_t>(out[i]) + static_cast<std::uint64_t>(values[i]));
  }
}

SampleRange Renderer::render(SampleRange wanted, const std::function<bool(const RenderProgress &)> &progress) {
  State &s = *state_;
  if (wanted.first >= wanted.last) return {wanted.first, wanted.first};
  if (wanted.last > (std::uint64_t(1) << 32)) throw UsageError("--samples", "sample numbers end at 2^32");
  std::vector<SampleRange> held = s.film.samples;
  insert_samples(held, wanted);  // throws before anything is added that is there already
  std::uint64_t per_sample = 0, begun = 0;
  for (const Tile &tile : s.tiles) per_sample += tile.paths_per_sample();
  const std::uint64_t total = per_sample * (wanted.last - wanted.first);
  SampleRange done{wanted.first, wanted.first};
  if (s.tiles.size() == 1) {
    done.last = s.render_tile(s.tiles[0], wanted, begun, total, progress);
  } else {
    // Every band gets the same samples: a call may end between them only.
    const std::uint64_t at_once = s.passes_each_sample() ? 1 : 16;
    bool go_on = true;
    while (go_on && done.last < wanted.last) {
      const SampleRange part{done.last, std::min(wanted.last, done.last + at_once)};
      for (const Tile &tile : s.tiles) s.render_tile(tile, part, begun, total, [&](const RenderProgress &p) { return go_on = go_on && (!progress || progress(p)), true; });
      done.last = part.last;
    }
  }
  insert_samples(s.film.samples, done);
  s.film.clamped = s.counters.sum.clamped;
  s.film.nan = s.counters.sum.nan;
  return done;
}

void Renderer::warm_up(const CompileProgress &progress) {
  State &s = *state_;
  s.place_tile(s.tiles[0]);
  s.device_frame.upload(std::span(&s.frame, 1));
  s.pool->counts.fill_zero();
  StageRunner runner(s.programs, s.scene, *s.pool, s.device_frame, s.device_film);
  std::vector<Stage> stages = s.plan.light_walk;
  stages.insert(stages.end(), s.walk.begin(), s.walk.end());
  if (s.light) s.light->look_at_nothing(runner);
  for (std::size_t i = 0; i < stages.size(); i++) {
    if (progress) progress(static_cast<double>(i) / static_cast<double>(stages.size()), "first launches");
    runner.run(stages[i]);
    s.device.finish();
  }
  s.device.take_times();
}

struct StageProbe::State {
  Renderer::State &render;
  std::unique_ptr<StageRunner> runner;
};

StageProbe::StageProbe(Renderer &renderer, SampleRange samples) : state_(new State{*renderer.state_, nullptr}) {
  Renderer::State &r = state_->render;
  r.begin_film(r.tiles[0]);
  state_->runner = std::make_unique<StageRunner>(r.programs, r.scene, *r.pool, r.device_frame, r.device_film);
  if (r.light) r.light->look(*state_->runner, *r.pool, r.counters, samples.first);
  r.frame.sample_first = static_cast<kernel::uint>(samples.first);
  r.device_frame.upload(std::span(&r.frame, 1));
  const std::uint64_t at_most = r.passes_each_sample() ? 1 : max_paths_of_a_launch / r.frame.paths_per_sample;
  r.counters.begin(*r.pool, 0, static_cast<kernel::uint>(std::min(samples.last - samples.first, at_most) * r.frame.paths_per_sample));
}
StageProbe::~StageProbe() = default;
StageProbe::StageProbe(StageProbe &&) noexcept = default;

const std::vector<Stage> &StageProbe::walk() const { return state_->render.walk; }

void StageProbe::warm_up(int steps) {
  for (int step = 0; step < steps; step++)
    for (const Stage stage : walk()) run(stage);
}

void StageProbe::run(Stage stage) { state_->runner->run(stage); }

StageState StageProbe::save() const {
  const Pool &pool = *state_->render.pool;
  return {pool.paths.download(), pool.status.download(), {pool.rays[0].download(), pool.rays[1].download()}, pool.shadow_queue.download(),
          pool.counts.download(), pool.walks.download(), pool.light_vertices.download(), pool.hits.download(), pool.shadow_rays.download(), state_->runner->current()};
}

void StageProbe::restore(const StageState &s) {
  const Pool &pool = *state_->render.pool;
  pool.paths.upload(s.paths);
  pool.status.upload(s.status);
  for (int i = 0; i < 2; i++) pool.rays[i].upload(s.rays[i]);
  pool.shadow_queue.upload(s.shadow_queue);
  pool.counts.upload(s.counts);
  pool.walks.upload(s.walks);
  pool.light_vertices.upload(s.light_vertices);
  pool.hits.upload(s.hits);
  pool.shadow_rays.upload(s.shadow_rays);
  state_->runner->set_current(s.current);
}

std::vector<std::int64_t> StageProbe::film() const { return state_->render.device_film.download(); }

std::size_t StageProbe::items(Stage stage) const {
  const std::vector<kernel::uint> counts = state_->render.pool->counts.download();
  if (stage == Stage::gather_paths) return state_->render.pool->slots;
  if (stage == Stage::occlude || stage == Stage::occlude_all) {  // every ray of the slots that have any
    const std::vector<kernel::uint> queue = state_->render.pool->shadow_queue.download(), status = state_->render.pool->status.download();
    std::size_t rays = 0;
    for (std::size_t i = 0; i < counts[SUN_COUNT_SHADOW]; i++) rays += (status[queue[i]] & SUN_STATUS_SHADOWS) >> SUN_STATUS_SHADOWS_SHIFT;
    return rays;
  }
  return counts[stage == Stage::generate ? SUN_COUNT_REFILL : SUN_COUNT_LIVE];
}

Display Renderer::display() const {
  State &s = *state_;
  if (s.plan.walk != std::vector{Stage::whitted}) throw Error("integrator " + s.plan.name, "has no fused walk to show frames by");
  if (s.tiles.size() != 1) throw Error("frame", "does not fit the device in one piece");
  s.place_tile(s.tiles[0]);
  return Display(s.device, s.programs.whitted(), static_cast<unsigned>(s.programs.variant.lanes), s.frame, s.scene);
}

const Film &Renderer::film() const { return state_->film; }
const RenderCounts &Renderer::counts() const { return state_->counters.sum; }
std::size_t Renderer::film_bytes() const { return state_->device_film.bytes(); }
std::size_t Renderer::scene_bytes() const { return state_->scene.bytes; }
unsigned Renderer::pool_slots() const { return state_->pool->slots; }
std::size_t Renderer::pool_bytes() const {
  const Pool &p = *state_->pool;
  return p.paths.bytes() + p.status.bytes() + p.hits.bytes() + p.shadow_rays.bytes() + p.branches.bytes() + 2 * p.rays[0].bytes() + p.shadow_queue.bytes() + p.walks.bytes() + p.light_vertices.bytes();
}

std::size_t Renderer::light_map_bytes() const { return state_->light ? state_->light->bytes() : 0; }

std::map<std::string, std::string> film_settings(const RenderSettings &s, const kernel::Camera &camera, std::span<const kernel::Camera> camera_keys) {
  Hasher hasher;
  hasher.bytes(&camera, sizeof camera);
  if (!camera_keys.empty()) hasher.span(camera_keys);
  std::map<std::string, std::string> all = {{"integrator", s.integrator},
          {"max_depth", std::to_string(s.max_depth)},
          {"roulette_depth", std::to_string(s.roulette_depth)},
          {"seed", std::to_string(s.seed)},
          {"sampler", s.independent ? "independent" : "sobol"},
          {"filter", filter_name(s.filter)},
          {"filter_radius", fmt::format("{}", s.filter.radius)},
          {"background", s.transparent_background ? "transparent" : "scene"},
          {"camera", hasher.digest().hex()}};
  if (s.time) all["time-at"] = fmt::format("{}", *s.time);
  if (s.shutter > 0) all["shutter"] = fmt::format("{}", s.shutter);
  for (const std::string &flag : integrator(s.integrator).takes) {
    const std::string name = flag.substr(2);
    if (flag == "--end-on-light") all[name] = s.end_on_light ? "yes" : "no";
    if (flag == "--sampling") all[name] = sampling_name(s.sampling);
    if (flag == "--light-samples") all[name] = std::to_string(s.light_samples);
    if (flag == "--indirect-samples") all[name] = std::to_string(s.indirect_samples);
    if (flag == "--nee") all[name] = s.nee_first ? "first" : "every";
    if (flag == "--absorption") all[name] = s.absorption < 0 ? "by throughput" : fmt::format("{}", s.absorption);
    if (flag == "--heuristic") all[name] = s.balance ? "balance" : "power";
    if (flag == "--strategy") all[name] = s.strategy_t ? fmt::format("{},{}", s.strategy_s, s.strategy_t) : "all";
    if (flag == "--unweighted") all[name] = s.unweighted ? "yes" : "no";
    if (flag == "--photons") all[name] = std::to_string(s.photons);
    if (flag == "--radius") all[name] = fmt::format("{}", s.radius);
    if (flag == "--caustic-radius") all[name] = fmt::format("{}", s.caustic_radius);
    if (flag == "--alpha") all[name] = fmt::format("{}", s.alpha);
    if (flag == "--ambient") all[name] = fmt::format("{},{},{}", s.ambient[0], s.ambient[1], s.ambient[2]);
    if (flag == "--cutoff") all[name] = fmt::format("{}", s.cutoff);
    if (flag == "--double-count") all[name] = s.double_count ? "yes: wrong on purpose, direct light counts twice" : "no";
  }
  return all;
}

}  // namespace sunstone
