// SPDX-License-Identifier: Apache-2.0
// sunstone render: a scene becomes pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "base/file.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "cli/stats.h"
#include "device/selftest.h"
#include "film/film_file.h"

namespace sunstone {

namespace {

constexpr double checkpoint_seconds = 30;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

bool is_film(const std::string &name) { return name.ends_with(".film"); }

class Render {
 public:
  Render(RenderOptions &options, Notices &notices) : o_(options), given_(options), notices_(notices), progress_(options.quiet) {}
  void run();

 private:
  void take_frame(std::uint64_t number);
  void check_outputs();
  void open();
  void resume();
  void render_range(SampleRange range);
  void write_outputs();
  void write_checkpoint();
  Film whole_film() const;
  void compile();
  bool go_on(const RenderProgress &p);
  bool render_picture();

  RenderOptions &o_;            // of the picture, or of the frame at hand
  RenderOptions given_;
  Notices &notices_;
  Progress progress_;
  RenderSettings settings_;
  Session session_;
  std::optional<Film> earlier_;  // --resume
  std::string reproducible_ = "unknown";
  double startup_ = 0, begun_ = 0, render_seconds_ = 0, last_update_ = 0, last_checkpoint_ = 0;
  double error_ = -1;            // estimated relMSE at the last look
  std::uint64_t samples_wanted_ = 0;
  SampleRange range_{};          // of the call that is running
  SampleRange all_{};
  bool paused_ = false;          // the call ended to write, not to end the render
  std::optional<FrameRange> frames_;
  std::uint64_t frame_ = 0;
};

// Time and names of a frame.
void Render::take_frame(std::uint64_t number) {
  frame_ = number;
  o_.import.time = settings_.time = frame_time(given_, number);
  for (std::size_t i = 0; i < o_.outputs.size(); i++) o_.outputs[i] = frame_name(given_.outputs[i], number);
  if (!o_.stats.empty()) o_.stats = frame_name(given_.stats, number);
}

void Render::check_outputs() {
  for (const std::string &name : o_.outputs) {
    if (!is_film(name)) check_picture_name(name);
    check_writable(name);
  }
  if (!o_.checkpoint.empty()) {
    if (!is_film(o_.checkpoint)) throw UsageError("--checkpoint " + printable(o_.checkpoint), "takes a .film");
    check_writable(o_.checkpoint);
  }
  if (!o_.stats.empty()) check_writable(o_.stats);
}

void Render::resume() {
  Film film = read_film(o_.resume);
  const std::string difference = film_difference(film, session_.renderer->film());
  if (!difference.empty()) throw Error(printable(o_.resume), "cannot be resumed: " + difference, "the same scene and the same flags as before are needed");
  // Goes on where the first gap is.
  std::uint64_t next = all_.first;
  for (const SampleRange &done : film.samples)
    if (done.first <= next && done.last > next) next = done.last;
  for (const SampleRange &done : film.samples)
    if (done.first > next && done.first < all_.last) all_.last = done.first;
  progress_.line(fmt::format("resuming {}: samples {}", printable(o_.resume), show_samples(film.samples)));
  all_.first = std::min(next, all_.last);
  earlier_ = std::move(film);
}

Film Render::whole_film() const {
  Film film = session_.renderer->film();
  film.interrupted = interrupted();
  film.information["version"] = SUNSTONE_VERSION;
  film.information["device"] = session_.device.info().description();
  film.information["scene"] = o_.scene;
  film.information["seconds"] = fmt::format("{:.3f}", render_seconds_);
  film.information["reproducible"] = reproducible_;
  if (earlier_) {
    if (film.samples.empty()) {
      // Nothing new was rendered: the earlier film as it is.
      Film same = *earlier_;
      same.information = film.information;
      same.interrupted = interrupted();
      return same;
    }
    add_film(film, *earlier_);
    film.interrupted = interrupted();  // whatever ended the earlier run, this one goes on
  }
  return film;
}

void Render::write_outputs() {
  const Film film = whole_film();
  for (const std::string &name : o_.outputs) {
    if (is_film(name)) write_film(name, film);
    else load_content().write_picture(name, film, o_.view);
  }
}

void Render::write_checkpoint() {
  if (!o_.checkpoint.empty()) write_film(o_.checkpoint, whole_film());
  last_checkpoint_ = now();
}

bool Render::go_on(const RenderProgress &p) {
  const double passed = now() - begun_;
  const double of_call = p.paths_wanted ? static_cast<double>(p.paths_begun) / static_cast<double>(p.paths_wanted) : 1;
  const double samples = static_cast<double>(range_.first - all_.first) + of_call * static_cast<double>(range_.last - range_.first);
  double fraction = samples / static_cast<double>(samples_wanted_);
  if (o_.seconds) fraction = std::max(fraction, std::min(1.0, passed / *o_.seconds));
  const double pixels = static_cast<double>(session_.renderer->film().pixels());
  const double left = fraction > 0 ? passed / fraction - passed : 0;
  std::string text = fmt::format("{:.0f}/{} samples, {}samples/s, {} left", samples, samples_wanted_, show_count(samples * pixels / std::max(passed, 1e-9)), show_seconds(left));
  if (o_.seconds && !o_.spp) text = fmt::format("{:.0f} samples, {}samples/s, {} left", samples, show_count(samples * pixels / std::max(passed, 1e-9)), show_seconds(left));
  if (error_ >= 0 && std::isfinite(error_)) text += fmt::format(", noise {:.2e}", error_);
  if (fraction < 1) progress_.bar(fraction, text);
  if (interrupted()) return false;
  if (o_.seconds && passed >= *o_.seconds) return false;
  const bool pause = (o_.update && now() - last_update_ >= *o_.update) || (!o_.checkpoint.empty() && now() - last_checkpoint_ >= checkpoint_seconds);
  paused_ = paused_ || pause;
  return !pause;
}

void Render::render_range(SampleRange range) {
  while (range.first < range.last) {
    paused_ = false;
    range_ = range;
    range.first = session_.renderer->render(range, [&](const RenderProgress &p) { return go_on(p); }).last;
    if (range.first < range.last && !paused_) return;
    const double at = now();
    if (o_.update && at - last_update_ >= *o_.update) {
      write_outputs();
      last_update_ = now();
    }
    if (!o_.checkpoint.empty() && at - last_checkpoint_ >= checkpoint_seconds) write_checkpoint();
    error_ = estimated_error(session_.renderer->film());
    if (interrupted() || (o_.seconds && now() - begun_ >= *o_.seconds)) return;
  }
}

void Render::compile() {
  constexpr double noticeable = 0.5;  // seconds: kernels that were compiled before are there sooner, and then there is nothing to say
  const double begun = now();
  compile_session(session_, o_, settings_, [&](double fraction, const std::string &what) {
    if (now() - begun > noticeable) progress_.bar(fraction, "compiling kernels, the first time on this device: " + what);
  });
  if (now() - begun > noticeable) progress_.bar(1, "kernels compiled in " + show_seconds(now() - begun));
  progress_.end_bar();
}

// Is there light that shadow rays cannot find, as solid glass bends it, and paths cannot, as its source is a point or a direction?
static bool glass_under_points(const Scene &scene) {
  return !scene.lights.empty() && std::ranges::any_of(scene.materials, [](const Material &m) { return m.transmission > 0 && m.volume && m.roughness * m.roughness < 1e-3f; });  // SUN_ALPHA_SMOOTH
}

void Render::open() {
  session_ = open_session(o_, settings_, notices_);
  progress_.line(session_.device.info().description());
  progress_.line(session_.loaded.line);
  const Plan &plan = integrator(settings_.integrator);
  if (!plan.leaves_out.empty())
    notices_.note("--integrator " + plan.name, "leaves out " + plan.leaves_out);
  else if (!plan.bidirectional && plan.light_walk.empty() && glass_under_points(session_.loaded.scene))
    notices_.note("--integrator " + plan.name, "leaves out what smooth glass gathers of lights without extent, which no path from the eye meets; --integrator sppm and --integrator vcm follow it");
  compile();
  const SelfTestResult self_test = cached_self_test(session_.device);
  reproducible_ = self_test.reproducible ? "yes" : "no";
  if (!self_test.reproducible)
    notices_.warning(session_.device.info().name, "rounds differently in " + self_test.differs + ": its picture may differ from other devices' in the last bits");
}

// From the first sample to the written files; false where a frame was interrupted, of which nothing is written.
bool Render::render_picture() {
  samples_wanted_ = std::max<std::uint64_t>(1, all_.last - all_.first);
  error_ = -1;
  begun_ = last_update_ = last_checkpoint_ = now();

  if (o_.error) {
    // Looked at after powers of two.
    std::uint64_t next = 2;
    SampleRange part = all_;
    while (part.first < all_.last) {
      part.last = std::min(all_.last, all_.first + next);
      render_range(part);
      const Film film = whole_film();
      error_ = estimated_error(film);
      if (interrupted() || (o_.seconds && now() - begun_ >= *o_.seconds) || error_ <= *o_.error) break;
      part.first = part.last;
      next *= 2;
    }
  } else {
    render_range(all_);
  }
  render_seconds_ = now() - begun_;
  progress_.bar(1, fmt::format("{}", show_seconds(render_seconds_)));
  progress_.end_bar();
  if (frames_ && interrupted()) {
    progress_.line(fmt::format("interrupted: frame {} is not written; --frames {}:{} goes on", frame_, frame_, frames_->last));
    return false;
  }

  const Film film = whole_film();
  if (film.samples.empty()) throw Error("", "interrupted before the first sample was done; nothing is written");
  write_outputs();
  write_checkpoint();
  if (!o_.stats.empty()) {
    const std::string text = render_stats(session_, film, {startup_, render_seconds_, reproducible_});
    write_file(o_.stats, std::as_bytes(std::span(text)));
  }
  if (settings_.double_count) notices_.warning("--double-count", "direct light is counted twice, on purpose: the picture is wrong, and its metadata says so");
  if (film.clamped) notices_.note("", fmt::format("{} contributions were beyond the film's range and clamped", film.clamped));
  if (film.nan) notices_.warning("", fmt::format("{} contributions were not finite and dropped", film.nan));
  const std::string frame = frames_ ? fmt::format("frame {}, at {:.6g} s: ", frame_, *settings_.time) : "";
  progress_.line(fmt::format("{}{}{} samples per pixel in {}, {}samples/s, film hash {}", frame, interrupted() ? "interrupted: " : "", film.sample_count(), show_seconds(render_seconds_),
                             show_count(static_cast<double>(session_.renderer->counts().paths) / std::max(render_seconds_, 1e-9)), film_hash(film).hex()));
  if (error_ = estimated_error(film); std::isfinite(error_)) progress_.line(fmt::format("noise (relMSE, estimated from two halves): {:.3e}", error_));
  for (const std::string &name : o_.outputs) progress_.line(printable(name, 400));
  if (!o_.checkpoint.empty()) progress_.line(printable(o_.checkpoint, 400));
  return true;
}

void Render::run() {
  frames_ = parse_frames(o_);
  settings_ = render_settings(o_);
  all_ = parse_samples(o_);
  if (o_.outputs.empty() && o_.checkpoint.empty()) o_.outputs.push_back(std::filesystem::path(o_.scene).stem().string() + ".png");
  given_ = o_;
  if (frames_) take_frame(frames_->first);
  check_outputs();
  catch_interrupts();
  open();
  if (!o_.resume.empty()) resume();
  startup_ = Progress::seconds();
  if (!render_picture() || !frames_) return;
  for (std::uint64_t number = frames_->first + 1; number < frames_->last; number++) {
    const double begun = now();
    take_frame(number);
    next_frame(session_, o_, settings_, notices_);
    startup_ = now() - begun;
    if (!render_picture()) return;
  }
}

}  // namespace

void add_render(CLI::App &app, CommandContext &context) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App *command = app.add_subcommand("render", "Render a scene");
  add_render_options(*command, *options);
  std::string integrators_text = "Integrators:\n";
  for (const Plan &plan : integrators()) integrators_text += fmt::format("  {:<12} {} ({})\n", plan.name, plan.summary, plan.source);
  command->footer(integrators_text +
                  "\nExamples:\n"
                  "  sunstone render scenes/cornell/cornell.gltf --size 512x512 -o cornell.png\n"
                  "  sunstone render model.glb --env sky.hdr --spp 256 -o model.exr -o model.png --aov all\n"
                  "  sunstone render big.glb --time 3600 --checkpoint big.film -o big.exr\n"
                  "  sunstone render model.glb --samples 0:512 -o first-half.film\n"
                  "  sunstone render walk.glb --frames 0:48 -o walk.png");
  command->callback([options, &context] {
    options->view.transparent_background = options->background == "transparent";
    context.quiet = options->quiet;
    Render(*options, context.notices).run();
  });
}

}  // namespace sunstone
