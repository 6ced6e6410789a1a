// SPDX-License-Identifier: Apache-2.0
// Rendering from a test: a scene, settings, and ways that may not change a bit.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/renderer.h"
#include "scene/scene.h"

namespace sunstone::test {

// How a picture is rendered: none of it changes a bit. What is not given is what suits the device.
struct Ways {
  unsigned pool = 0;
  std::optional<unsigned> lanes, chunk;
  std::optional<Layout> layout;
  std::optional<bool> columns, few_shapes;
  std::optional<int> motion;  // SUN_MOTION of the programs; as the scene needs
  std::size_t work_group = 0;
  bool trimmed = false;  // code that the scene does not need is left out, as the command does; otherwise one set of programs serves all scenes
};

// One thing each that is another than in Ways{}, by name.
std::vector<std::pair<std::string, Ways>> other_ways();

// The device of all tests of this process: $SUNSTONE_TEST_DEVICE, or what the command would choose. Opened once for each work-group size.
const Device &test_device(std::size_t work_group = 0);

// A scene that has been checked, with what is made of it kept.
class Case {
 public:
  explicit Case(Scene scene);
  static Case file(const std::filesystem::path &path);
  const Scene &scene() const { return scene_; }
  const FlatScene &flat(Layout layout) const;
  kernel::Camera camera(int width, int height) const;  // where it moves, what flat() gave gets its keys

 private:
  Scene scene_;
  mutable std::map<Layout, FlatScene> flat_;
};

struct Rendered {
  Film film;
  RenderCounts counts;
};

// A whole picture with every bounce kept.
RenderSettings picture(int width, int height, unsigned max_depth);
Filter box_filter();

// From the scene's camera, or another.
Rendered render(const Case &scene, const RenderSettings &settings, SampleRange samples, const Ways &ways = {},
                const std::function<bool(const RenderProgress &)> &progress = {}, const kernel::Camera *camera = nullptr);

// The last of the frames for a display that these cameras give, begun one after the other.
std::vector<kernel::uint> show(const Case &scene, const RenderSettings &settings, std::span<const kernel::Camera> cameras, float scale, const Ways &ways = {});

// A sample, twice by one renderer and each time into a new film: the integers of both, layer by layer.
std::array<std::vector<std::int64_t>, 2> render_twice(const Case &scene, const RenderSettings &settings, std::uint64_t sample);

// Of one renderer: `samples`, then `more`.
struct Twice {
  Film first, then;
  RenderCounts counted_first, counted_then;
  std::string refused;  // what it said to `more`, if it did not render it
};
Twice render_more(const Case &scene, const RenderSettings &settings, SampleRange samples, SampleRange more);

// What of the settings a renderer refuses, as a UsageError names it; empty where it renders.
std::string refusal(const Case &scene, const RenderSettings &settings);

// One film a seed, from 1 on, with the independent sampler.
std::vector<Film> render_seeds(const Case &scene, RenderSettings settings, std::uint64_t samples, std::uint32_t seeds, const Ways &ways = {});

// A window of pixels of a film, half-open.
struct Window {
  int x0, y0, x1, y1;
};
Window whole(const Film &film);

// The mean of a layer over a window; "beauty" is the sum of its halves.
double mean(const Film &film, const std::string &layer, const Window &window, int channel);
// The same by film, for statistics.
std::vector<double> means(const std::vector<Film> &films, const std::string &layer, const Window &window, int channel);

// Holds the mean over `films` against a closed form: within the interval that a right renderer leaves with chance 10^-9, plus `rounding` times the
// expectation. Empty where it holds; otherwise what was expected and what came.
std::string differs(const std::vector<Film> &films, const std::string &layer, const Window &window, const glm::vec3 &expected, double rounding = 1e-5);

}  // namespace sunstone::test
