// SPDX-License-Identifier: Apache-2.0
// Textures and emitters on a device: the host's bits at every width, over what flatten lays out.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "device/kernel.h"
#include "host/flatten/flatten_support.h"
#include "math/vector.h"
#include "scene/emitter.h"
#include "scene/texture.h"

namespace sunstone {
namespace {

constexpr kernel::uint count = 16384, words = 16;

// Two textures of different formats, three kinds of light, an environment map and a few triangles that emit.
FlatScene scene_to_probe() {
  Scene scene = scene_of(square(0));
  Random random(1);
  std::vector<float> floats(3 * 9 * 5), sky(3 * 16 * 8);
  for (float &x : floats) x = random.between(-2, 2);
  for (float &x : sky) x = random.number() * random.number() * 9;
  scene.images = {byte_image(13, 6, 4, 2), float_image(9, 5, 3, floats)};
  scene.textures = {{0, Wrap::mirror, Wrap::repeat, true}, {1, Wrap::clamp, Wrap::mirror, true}};
  Material &material = scene.materials.emplace_back();
  material.emission = {1, 2, 3};
  material.base_color_texture.texture = 0;
  material.metallic_roughness_texture.texture = 1;
  material.metallic_roughness_texture.transform = glm::mat3x2(0.7f, 0.1f, -0.3f, 1.7f, 0.2f, 0.4f);
  for (Light::Kind kind : {Light::Kind::point, Light::Kind::spot, Light::Kind::directional}) {
    Light light;
    light.kind = kind;
    light.position = {0.5f, 0.2f, 4};
    light.intensity = {3, 4, 5};
    scene.lights.push_back(light);
  }
  scene.environment.kind = Environment::Kind::map;
  scene.environment.map = std::make_shared<Image>(float_image(16, 8, 3, sky));
  scene.environment.rotation = 0.15f;
  return flattened(scene);
}

std::array<float, words> expected(const FlatScene &flat, kernel::uint item, float u0, float u1) {
  kernel::TexturePages pages;
  for (auto &page : pages.page) page = flat.texel_pages[0].data();
  const float uv[2] = {u0 * 6.0f - 3.0f, u1 * 6.0f - 3.0f};
  const auto texel =
      kernel::sample_slot(&pages, flat.textures.data(), flat.texture_refs.data(), flat.tables.data(), item & 1, uv, uv, (item & 6) != 6);
  const auto choice = kernel::choose_emitter(flat.emitters.data(), static_cast<kernel::uint>(flat.emitters.size()), u0);
  const kernel::vec3 place = kernel::make_vec3(uv[0], uv[1], u0 + u1);
  const auto light = kernel::light_sample(flat.lights.data(), item % 3, place);
  const auto sky = kernel::environment_sample(&flat.environment, flat.environment_cdf.data(), u0, u1);
  const auto radiance = kernel::environment_radiance(&flat.environment, flat.environment_texels.data(), sky.direction);
  return {texel.r,
          texel.g,
          texel.b,
          texel.a,
          static_cast<float>(choice.index),
          choice.pmf,
          light.direction.x,
          light.distance,
          light.radiance.y,
          sky.direction.x,
          sky.direction.y,
          sky.direction.z,
          sky.pdf,
          radiance.x,
          radiance.z,
          kernel::environment_pdf(&flat.environment, flat.environment_cdf.data(), kernel::normalize3(place))};
}

class EmitterDevice : public testing::TestWithParam<int> {};

TEST_P(EmitterDevice, GivesTheHostsBits) {
  Notices notices;
  const auto devices = list_devices(notices);
  if (devices.empty()) GTEST_SKIP() << "no OpenCL device";
  const char *selector = std::getenv("SUNSTONE_TEST_DEVICE");
  const Device device(choose_device(devices, selector ? selector : ""), {});
  std::ifstream file(SUNSTONE_SOURCE_DIR "/tests/kernels/probes/emitter.cl");
  std::stringstream text;
  text << file.rdbuf();
  const Program program = Program::from_text(device, "emitter.cl", text.str(), {{"LANES", GetParam()}});

  const FlatScene flat = scene_to_probe();
  ASSERT_EQ(flat.texture_refs.size(), 2u);
  std::vector<float> numbers(2 * count);
  Random random(77);
  for (float &number : numbers) number = random.number();
  const auto upload = [&]<class T>(const std::vector<T> &values) { return Buffer<T>(device, std::span<const T>(values), "probe"); };
  const Buffer<float> out(device, words * count, "results");
  Kernel probe(program, "probe_emitter");
  probe.run(count / static_cast<std::size_t>(GetParam()), out, upload(numbers), count, static_cast<kernel::uint>(flat.emitters.size()),
            upload(flat.texel_pages[0]), upload(flat.textures), upload(flat.texture_refs), upload(flat.tables), upload(flat.emitters),
            upload(flat.lights), upload(std::vector{flat.environment}), upload(flat.environment_texels), upload(flat.environment_cdf));
  const std::vector<float> results = out.download();
  for (kernel::uint i = 0; i < count; i++) {
    const auto want = expected(flat, i, numbers[i], numbers[count + i]);
    for (kernel::uint k = 0; k < words; k++)
      ASSERT_EQ(kernel::as_uint(results[k * count + i]), kernel::as_uint(want[k])) << "word " << k << " of item " << i << ": " << want[k];
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, EmitterDevice, testing::Values(1, 8, 16));

}  // namespace
}  // namespace sunstone
