// SPDX-License-Identifier: Apache-2.0
// sunstone verify: may this device and driver be trusted?
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/session.h"
#include "cli/verify_scene.h"
#include "device/selftest.h"

namespace sunstone {

namespace {

// What the little scene has to give on every device, by integrator. A change of the renderer that changes pictures changes these: `sunstone verify`
// prints what it found, and tests/cli holds PoCL to them.
struct Expected {
  const char *integrator, *film_hash;
  bool shapes = false;  // of the other little scene
};
constexpr Expected expected[] = {{"path", "fde23fd9c9a6d6faee8566fa5c158c67"},
                                 {"pure", "3b658440b4f7897397804b2ff7fd1ac8"},
                                 {"hybrid", "72251da841739d3e1bd54f0be1122530"},
                                 {"distribution", "fdc18a93b42d0a165edb779d587e297a"},
                                 {"whitted", "cc0e053e0b23a1e51092dc7340a8bb8b"},
                                 {"bdpt", "35282e7b9dcb2534bfe2fbb04bb21858"},
                                 {"sppm", "f257a2a346d1000de8d6782f0065bc7e"},
                                 {"photon", "29961b6c109810fc9e91c70ba4ac5eb6"},
                                 {"vcm", "a0cd32fb3b7d8bc01aa4cce560e2665b"},
                                 {"whitted", "3feeb7b0f53abe26bcf6622188050b26", true}};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

class Verify {
 public:
  Verify(std::string selector, bool json, Notices &notices) : selector_(std::move(selector)), json_(json), notices_(notices) {}
  bool run();

 private:
  void tell(bool good, const std::string &what, const std::string &found);
  void memory(const Device &device);
  void scenes(const Device &device);

  std::string selector_;
  bool json_, good_ = true;
  Notices &notices_;
  nlohmann::ordered_json checks_ = nlohmann::ordered_json::array();
};

void Verify::tell(bool good, const std::string &what, const std::string &found) {
  good_ = good_ && good;
  checks_.push_back({{"check", what}, {"passed", good}, {"found", found}});
  if (!json_) {
    fmt::print("{} {:<40} {}\n", good ? "pass" : "FAIL", what, found);
    std::fflush(stdout);
  }
}

// Patterns written, copied back and compared, in one piece of a quarter of what the device allows, 256 MiB at most.
void Verify::memory(const Device &device) {
  const std::size_t words = std::min<std::size_t>(device.info().max_allocation / 4, std::size_t(1) << 28) / sizeof(std::uint32_t);
  std::vector<std::uint32_t> pattern(words);
  for (std::size_t i = 0; i < words; i++) pattern[i] = static_cast<std::uint32_t>(i * 2654435761u);
  const double begun = now();
  const Buffer<std::uint32_t> buffer(device, std::span<const std::uint32_t>(pattern), "memory test");
  const bool same = buffer.download() == pattern;
  const double gigabytes = 2.0 * static_cast<double>(words * sizeof(std::uint32_t)) * 1e-9;
  tell(same, "memory", fmt::format("{:.0f} MiB there and back, {:.1f} GB/s", gigabytes / 2 * 953.67, gigabytes / (now() - begun)));
}

void Verify::scenes(const Device &device) {
  const Content &content = load_content();
  const Variant suited = device_variant(device.info());
  std::vector<Variant> variants = {suited};
  Variant plain = suited;
  plain.lanes = 1;
  plain.layout = Layout::binary;
  if (!(plain == suited)) variants.push_back(plain);
  for (const Variant &variant : variants) {
    std::unique_ptr<Programs> programs;
    for (const Expected &e : expected) {
      Scene scene = e.shapes ? make_verify_shapes() : make_verify_scene(integrator(e.integrator).refuses.empty());
      FlattenOptions flatten;
      flatten.layout = variant.layout;
      flatten.max_page_bytes = device.info().max_allocation;
      const FlatScene flat = content.flatten(scene, flatten, notices_);
      const std::string title = fmt::format("{}{}, lanes {}, {}", e.integrator, e.shapes ? " of shapes" : "", variant.lanes, layout_name(variant.layout));
      const double begun = now();
      RenderSettings settings;
      settings.width = settings.x1 = 64;
      settings.height = settings.y1 = 48;
      settings.integrator = e.integrator;
      settings.max_depth = 6;
      const std::string name = e.integrator;
      if (name == "hybrid" || name == "distribution") settings.light_samples = 3;
      if (name == "hybrid") settings.absorption = 0.25f;
      if (name == "distribution") settings.indirect_samples = 2;
      if (name == "photon") settings.photons = 20000;
      if (name == "whitted") settings.ambient = {0.2f, 0.3f, 0.4f};
      const Variant wanted = scene_variant(variant, flat, settings);
      if (!programs || !(programs->variant == wanted)) programs = std::make_unique<Programs>(device, wanted);
      Renderer renderer(device, *programs, flat, content.flatten_camera(scene.cameras[0], settings.width, settings.height), settings, {});
      renderer.render({0, 2}, {});
      const double cold = now() - begun;
      const double warm_begun = now();
      renderer.render({2, 4}, {});
      const std::string hash = film_hash(renderer.film()).hex();
      tell(hash == e.film_hash, title, fmt::format("{} (first samples {:.2f} s, the same again {:.2f} s)", hash, cold, now() - warm_begun));
      const RenderCounts &counts = renderer.counts();
      if (counts.nan) tell(false, title + ": finite", fmt::format("{} contributions were not", counts.nan));
    }
  }
}

bool Verify::run() {
  const DeviceInfo info = choose_device(list_devices(notices_), selector_);
  const Device device(info, {});
  if (!json_) fmt::print("{}\n", info.description());
  const SelfTestResult operations = self_test(device);
  tell(operations.reproducible, "operations", operations.reproducible ? fmt::format("every result as on the host, {:.2f} s", operations.seconds) : operations.differs + " differs");
  memory(device);
  scenes(device);
  const std::string verdict = good_ ? "this device gives sunstone's bits" : operations.reproducible ? "this device or driver is not to be trusted" : "this device renders, but not with the same bits";
  if (json_) fmt::print("{}\n", nlohmann::ordered_json{{"device", info.description()}, {"passed", good_}, {"verdict", verdict}, {"checks", checks_}}.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  else fmt::print("\n{}\n", verdict);
  return good_;
}

}  // namespace

void add_verify(CLI::App &app, CommandContext &context) {
  struct Options {
    std::string device;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App *command = app.add_subcommand("verify", "Test a device and its driver: operations, memory, a small scene per integrator against known hashes");
  command->add_option("--device", options->device, "Number, part of the name, cpu or gpu [as render chooses]")->type_name("SELECTOR");
  command->add_flag("--json", options->json, "Print JSON");
  command->footer("Exit status 0 where the device gives the same bits as all others, 1 where it does not.\n\nExample:\n  sunstone verify --device gpu");
  command->callback([options, &context] {
    if (!Verify(options->device, options->json, context.notices).run()) context.exit_status = 1;
  });
}

}  // namespace sunstone
