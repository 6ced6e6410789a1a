// SPDX-License-Identifier: Apache-2.0
#include "learn/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/error.h"

namespace sunstone {

static double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Studio::Studio(Device device, Variant variant, SceneLoader load, StudioProgress progress)
    : device_(std::move(device)), variant_(variant), load_(std::move(load)), progress_(std::move(progress)) {}

const StudioScene &Studio::scene(const Shot &shot) {
  const std::string key = fmt::format("{}\n{}\n{}x{}", shot.scene, shot.environment, shot.settings.width, shot.settings.height);
  const auto found = scenes_.find(key);
  if (found != scenes_.end()) return found->second;
  return scenes_.emplace(key, load_(shot, variant_.layout)).first->second;
}

std::unique_ptr<Renderer> Studio::renderer(const Shot &shot, unsigned pool) {
  const StudioScene &scene = this->scene(shot);
  const Variant variant = scene_variant(variant_, scene.flat, shot.settings);
  const auto same = [&](const std::unique_ptr<Programs> &programs) { return programs->variant == variant; };
  auto found = std::ranges::find_if(programs_, same);
  if (found == programs_.end()) {
    tell(0);
    programs_.push_back(std::make_unique<Programs>(device_, variant));
    found = programs_.end() - 1;
  }
  auto renderer = std::make_unique<Renderer>(device_, **found, scene.flat, scene.camera, shot.settings, Tuning{pool, variant.lanes});
  renderer->warm_up({});
  return renderer;
}

void Studio::span(double begin, double end) {
  begin_ = begin;
  end_ = end;
  done_ = share_ = 0;
}

void Studio::piece(double share, const std::string &text) {
  done_ += share_;
  share_ = share;
  text_ = text;
  tell(0);
}

void Studio::tell(double of_piece) {
  if (progress_ && !progress_(begin_ + (end_ - begin_) * std::clamp(done_ + share_ * of_piece, 0.0, 1.0), text_))
    throw Error("", "interrupted", "figures that were done are whole and stay");
}

void Studio::render(Renderer &renderer, SampleRange samples) {
  bool wanted = true;
  const auto look = [&](const RenderProgress &p) {
    const double fraction = p.paths_wanted ? static_cast<double>(p.paths_begun) / static_cast<double>(p.paths_wanted) : 1.0;
    if (progress_) wanted = progress_(begin_ + (end_ - begin_) * std::clamp(done_ + share_ * fraction, 0.0, 1.0), text_);
    return wanted;
  };
  renderer.render(samples, look);
  if (!wanted) throw Error("", "interrupted", "figures that were done are whole and stay");
}

double Studio::render_for(Renderer &renderer, std::uint64_t first, double seconds) {
  bool wanted = true;
  const double begun = now();
  renderer.render({first, std::uint64_t(1) << 31}, [&](const RenderProgress &) {
    const double passed = now() - begun;
    if (progress_) wanted = progress_(begin_ + (end_ - begin_) * std::clamp(done_ + share_ * passed / seconds, 0.0, 1.0), text_);
    return wanted && passed < seconds;
  });
  if (!wanted) throw Error("", "interrupted", "figures that were done are whole and stay");
  return now() - begun;
}

RenderSettings figure_settings(int width, int height, const std::string &integrator, unsigned max_depth) {
  RenderSettings s;
  s.width = s.x1 = width;
  s.height = s.y1 = height;
  s.integrator = integrator;
  s.max_depth = max_depth;
  s.filter = {Filter::Kind::box, 0.5f};
  s.layers.bounces = true;
  return s;
}

}  // namespace sunstone
