// SPDX-License-Identifier: Apache-2.0
// The paths of one pixel, vertex by vertex: the renderer's own stages are run one at a time on a pool that holds one path, and what they leave in the
// pool and on the film is read after each. Nothing is traced a second time by other code.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "film/film.h"
#include "learn/studio.h"

namespace sunstone {

using Triple = std::array<double, 3>;

struct TracedShadowRay {
  Triple from{}, to{};      // the point on the emitter; far away for an environment
  bool far = false;
  Triple worth{};           // its contribution where nothing blocks
};

// One hit, or where a path left the scene.
struct TracedVertex {
  enum class Kind { surface, emitter, escaped } kind = Kind::surface;
  enum class Leaves { ended, scattered, delta, straight } leaves = Leaves::ended;  // delta: by mirror or smooth glass; straight: a null event
  unsigned depth = 0;            // scatterings before it
  Triple from{}, position{};     // where the ray began, and the hit; an escaped ray has its direction here
  Triple normal{};               // of the surface, to the side of the ray; 0 where escaped
  double pdf_arriving = 0;       // density of the direction that led here, per steradian; 0: camera or delta
  double pdf_leaving = 0;        // of the next direction; 0: delta, or none
  Triple throughput{}, throughput_after{};  // of the ray that arrived and, roulette done, of the one that leaves
  Triple emission{};             // what it added to the film by shining
  std::vector<TracedShadowRay> shadow_rays;
  Triple direct{};               // what they added together
  unsigned instance = 0, primitive = 0;
  std::string material;
};

struct TracedPath {
  std::uint64_t sample = 0;
  Triple camera{};               // where it begins
  std::vector<TracedVertex> vertices;
  const char *ended = "";        // light, depth, escaped, absorbed
  Triple contribution{};         // all that it added to its pixel
};

struct TracedPixel {
  std::vector<TracedPath> paths;
  std::vector<std::int64_t> film;  // the pixel's integers, of all these samples
};

// Of samples [first, first + count) of pixel (x, y).
TracedPixel trace_pixel(Studio &studio, Shot shot, int x, int y, SampleRange samples);

// Where a point stands in the picture, in pixels, y down; false where it is not in front of the camera.
bool project(const kernel::Camera &camera, int width, int height, const Triple &point, double &x, double &y);

}  // namespace sunstone
