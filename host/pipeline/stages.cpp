// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stages.h"

#include <algorithm>
#include <numeric>

#include "shared/bidirectional.h"
#include "shared/options.h"
#include "shared/path_words.h"

namespace sunstone {

namespace {

Switches shading(const Variant &v) {
  return {{"LANES", static_cast<int>(v.lanes)}, {"SUN_COLUMNS", v.columns}, {"SUN_SPECULAR", v.specular}, {"SUN_TEXTURES", v.textures}, {"SUN_SHAPES", v.shapes}, {"SUN_MOTION", v.motion}};
}
Switches tracing(const Variant &v) {
  Switches switches = shading(v);
  switches["LANES"] = 1;
  switches["SUN_LAYOUT"] = v.layout == Layout::binary ? SUN_LAYOUT_BINARY : v.layout == Layout::wide8 ? SUN_LAYOUT_WIDE8 : SUN_LAYOUT_WIDE16;
  switches["SUN_PASSABLE"] = v.passable;
  switches["SUN_BIDIRECTIONAL"] = v.bidirectional;
  return switches;
}

// Of the program that works on paths.
Switches on_paths(const Variant &v) {
  Switches switches = shading(v);
  switches["SUN_CHUNK"] = static_cast<int>(v.chunk);
  switches["SUN_BRANCHING"] = v.branching;
  switches["SUN_PHOTONS"] = v.photons;
  switches["SUN_MERGING"] = v.light_map && !v.photons;
  return switches;
}

std::vector<std::string> stages_on_paths(const Variant &v) {
  std::vector<std::string> stages = {"generate", "first_hit", "shade", "roulette", "compact"};
  if (v.branching) stages.push_back("branch");
  if (v.bidirectional) stages.insert(stages.end(), {"emit", "deposit"});
  if (v.bidirectional && !v.photons) stages.push_back("connect");
  if (v.light_map) stages.push_back("gather");
  return stages;
}
std::vector<std::string> stages_on_rays(const Variant &v) {
  std::vector<std::string> stages = {"intersect", "occlude"};
  if (v.bidirectional && !v.photons) stages.push_back("occlude_all");
  return stages;
}

// A program of several stages.
Program build_stages(const Device &device, const std::string &name, const std::vector<std::string> &stages, const Switches &switches, int number,
                     const CompileProgress &progress) {
  constexpr double programs = 2;
  if (progress) progress(number / programs, name);
  std::string text;
  for (const std::string &stage : stages) text += "#include \"stages/" + stage + ".cl\"\n";
  return Program::from_text(device, name, text, switches);
}

}  // namespace

Variant device_variant(const DeviceInfo &info) {
  Variant variant;
  variant.layout = device_layout(info);
  if (info.cpu && info.native_float_width >= 8) {
    variant.lanes = info.native_float_width >= 16 ? 16 : 8;
  } else if (!info.cpu) {
    variant.columns = info.gpu;
    variant.chunk = info.gpu ? 64 : 1024;
  }
  return variant;
}

Variant integrator_variant(Variant variant, const RenderSettings &settings) {
  const Plan &plan = integrator(settings.integrator);
  variant.light_map = !plan.light_walk.empty();
  variant.bidirectional = plan.bidirectional || variant.light_map;
  variant.photons = plan.photons;
  variant.branching = branches(settings);
  return variant;
}

Variant scene_variant(Variant variant, const FlatScene &scene, const RenderSettings &settings) {
  variant = integrator_variant(variant, settings);
  variant.passable = scene.has_passable;
  variant.specular = scene.has_specular;
  variant.shapes = scene.shape_count > 0;
  variant.motion = scene.motion();
  constexpr std::size_t few = 32;  // beyond, a tree is quicker than asking each
  variant.few_shapes = scene.motion() == 0 && scene.shape_count > 0 && scene.shape_count <= few;
  variant.triangles = scene.triangles.size() > scene.shape_count;
  variant.textures = scene.has_textures;
  return variant;
}

Layout device_layout(const DeviceInfo &info) {
  if (!info.cpu || info.native_float_width < 4) return Layout::binary;
  return info.native_float_width >= 16 ? Layout::wide16 : Layout::wide8;
}

Programs::Programs(const Device &device, const Variant &v, const CompileProgress &progress)
    : variant(v),
      paths(build_stages(device, "paths", stages_on_paths(v), on_paths(v), 0, progress)),
      rays(build_stages(device, "rays", stages_on_rays(v), tracing(v), 1, progress)),
      device_(device) {}

const Program &Programs::maps() const {
  if (!maps_) maps_ = build_stages(device_, "maps", {"collect", "sort"}, {{"LANES", 1}}, 0, {});
  return *maps_;
}

const Program &Programs::whitted() const {
  if (!whitted_) {
    Switches switches = tracing(variant);
    switches["LANES"] = static_cast<int>(variant.lanes);
    switches["SUN_FEW_SHAPES"] = variant.few_shapes;
    switches["SUN_TRIANGLES"] = variant.triangles;
    whitted_ = build_stages(device_, "whitted", {"whitted"}, switches, 0, {});
  }
  return *whitted_;
}

Pool::Pool(const Device &device, unsigned slots_, unsigned chunk, unsigned light_samples_, unsigned branch_records, unsigned light_vertices_)
    : slots(slots_),
      chunks((slots_ + chunk - 1) / chunk),
      light_samples(light_samples_),
      paths(device, static_cast<std::size_t>(slots) * kernel::SUN_PATH_WORDS, "paths"),
      status(device, slots, "path status"),
      hits(device, slots, "hits"),
      shadow_rays(device, static_cast<std::size_t>(slots) * light_samples, "shadow rays"),
      branches(device, std::max<std::size_t>(1, static_cast<std::size_t>(slots) * branch_records * 16), "branches"),
      walks(device, light_vertices_ ? static_cast<std::size_t>(slots) * SUN_WALK_WORDS : 0, "walks"),
      light_vertices(device, static_cast<std::size_t>(slots) * light_vertices_ * SUN_LIGHT_VERTEX_RECORDS * 16, "light vertices"),
      rays{Buffer<kernel::uint>(device, slots, "ray queue"), Buffer<kernel::uint>(device, slots, "ray queue")},
      shadow_queue(device, slots, "shadow queue"),
      chunk_counts(device, chunks, "queue chunks"),
      counts(device, 2 * SUN_COUNT_WORDS, "counts") {
  std::vector<kernel::uint> order(slots);
  std::iota(order.begin(), order.end(), 0u);
  rays[0].upload(order);
  status.fill_zero();
  paths.fill_zero();
  branches.fill_zero();
  walks.fill_zero();
  light_vertices.fill_zero();  // lanes without a vertex load one all the same: what is in it has to be an index, a roughness
}

StageRunner::StageRunner(const Programs &p, const DeviceScene &scene, const Pool &pool, const Buffer<kernel::Frame> &frame, const Buffer<std::int64_t> &film)
    : programs_(p),
      scene_(scene),
      pool_(pool),
      frame_(frame),
      film_(film),
      lanes_(p.variant.lanes),
      generate_(p.paths, "generate"),
      intersect_(p.rays, "intersect"),
      first_hit_(p.paths, "first_hit"),
      shade_(p.paths, "shade"),
      occlude_(p.rays, "occlude"),
      roulette_(p.paths, "roulette"),
      count_(p.paths, "count_chunks"),
      scan_(p.paths, "scan"),
      scatter_(p.paths, "scatter_chunks") {
  if (p.variant.branching) branch_.emplace(p.paths, "branch");
  if (!p.variant.bidirectional) return;
  emit_.emplace(p.paths, "emit");
  deposit_.emplace(p.paths, "deposit");
  if (p.variant.light_map) gather_.emplace(p.paths, "gather");
  if (!p.variant.photons) {
    connect_.emplace(p.paths, "connect");
    occlude_all_.emplace(p.rays, "occlude_all");
  }
}

void StageRunner::gather(unsigned bit, const Buffer<kernel::uint> &queue, const Buffer<kernel::uint> &out) {
  count_.run(pool_.chunks, frame_, queue, pool_.status, pool_.counts, pool_.chunk_counts, bit);
  scan_.run(1, frame_, pool_.counts, pool_.chunk_counts, bit);
  scatter_.run(pool_.chunks, frame_, queue, pool_.status, pool_.counts, pool_.chunk_counts, out, bit);
}

void StageRunner::look_at(const LightMap &map, const LightGrid &all, const LightGrid *caustics) {
  map_ = &map;
  all_ = &all;
  caustics_ = caustics;
}

void StageRunner::run_gather(const LightGrid &grid, kernel::uint phase) {
  gather_->run((pool_.slots + lanes_ - 1) / lanes_, frame_, scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1],
               scene_.pages[2], scene_.pages[3], pool_.paths, pool_.walks, pool_.status, pool_.hits, map_->vertices(), grid.entries, grid.starts, map_->records(), grid.mask, grid.radius, phase,
               pool_.rays[current_], pool_.counts, film_);
}

void StageRunner::run(Stage stage) {
  const Buffer<kernel::uint> &rays = pool_.rays[current_];
  const std::size_t bundles = (pool_.slots + lanes_ - 1) / lanes_;
  switch (stage) {
    case Stage::gather_paths:
      gather(SUN_STATUS_ALIVE, rays, pool_.rays[1 - current_]);
      current_ = 1 - current_;
      break;
    case Stage::generate: generate_.run(bundles, frame_, scene_.records, pool_.paths, pool_.status, rays, pool_.counts); break;
    case Stage::intersect:
      intersect_.run(pool_.slots, frame_, scene_.nodes, scene_.leaves, scene_.instance_list, scene_.roots, scene_.top_root, scene_.fragments, scene_.instances, pool_.paths,
                     pool_.status, pool_.hits, rays, pool_.counts);
      break;
    case Stage::first_hit:
      first_hit_.run(bundles, frame_, scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1],
                     scene_.pages[2], scene_.pages[3], pool_.paths, pool_.status, pool_.hits, rays, pool_.counts, film_);
      break;
    case Stage::shade:
      shade_.run(bundles, frame_, scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1],
                 scene_.pages[2], scene_.pages[3], pool_.paths, pool_.status, pool_.hits, pool_.shadow_rays, pool_.branches, rays, pool_.counts, film_);
      break;
    case Stage::gather_shadow_rays: gather(SUN_STATUS_SHADOW, rays, pool_.shadow_queue); break;
    case Stage::occlude:
      for (unsigned number = 0; number < pool_.light_samples; number++)
        occlude_.run(pool_.slots, frame_, scene_.nodes, scene_.leaves, scene_.instance_list, scene_.roots, scene_.top_root, scene_.fragments, scene_.vertices, scene_.extras,
                   scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2], scene_.pages[3], pool_.shadow_rays,
                   pool_.shadow_queue, pool_.counts, film_, number * pool_.slots);
      break;
    case Stage::emit:
      emit_->run(bundles, frame_, scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2],
                 scene_.pages[3], pool_.paths, pool_.walks, pool_.status, rays, pool_.counts);
      break;
    case Stage::deposit:
      deposit_->run(bundles, frame_, scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2],
                    scene_.pages[3], pool_.paths, pool_.walks, pool_.light_vertices, pool_.status, pool_.hits, pool_.shadow_rays, rays, pool_.counts);
      break;
    case Stage::connect:
      connect_->run(bundles, frame_, scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2],
                    scene_.pages[3], pool_.paths, pool_.walks, map_ ? map_->vertices() : pool_.light_vertices, map_ ? map_->path_starts() : pool_.light_vertices, pool_.status,
                    pool_.hits, pool_.shadow_rays, rays, pool_.counts, film_);
      break;
    case Stage::occlude_all:
      occlude_all_->run(pool_.slots, frame_, scene_.nodes, scene_.leaves, scene_.instance_list, scene_.roots, scene_.top_root, scene_.fragments, scene_.vertices, scene_.extras,
                        scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2], scene_.pages[3], pool_.shadow_rays,
                        pool_.shadow_queue, pool_.status, pool_.counts, film_);
      break;
    case Stage::whitted:
      if (!whitted_) {
        whitted_.emplace(programs_.whitted(), "whitted");
        whitted_next_.emplace(programs_.whitted(), "whitted_next");
      }
      whitted_->run(bundles, frame_, scene_.nodes, scene_.leaves, scene_.instance_list, scene_.roots, scene_.top_root, scene_.fragments, scene_.vertices, scene_.extras,
                    scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2], scene_.pages[3], pool_.counts, film_);
      whitted_next_->run(1, frame_, pool_.counts);
      break;
    case Stage::gather: run_gather(*all_, caustics_ ? SUN_PHASE_FINAL : SUN_PHASE_SHARP); break;
    case Stage::gather_caustics: run_gather(*caustics_, SUN_PHASE_SHARP); break;
    case Stage::roulette: roulette_.run(bundles, frame_, pool_.paths, pool_.status, pool_.branches, rays, pool_.counts); break;
    case Stage::branch: branch_->run(bundles, frame_, pool_.paths, pool_.status, pool_.hits, pool_.branches, rays, pool_.counts); break;
  }
}

}  // namespace sunstone
