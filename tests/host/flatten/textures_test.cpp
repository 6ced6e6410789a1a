// SPDX-License-Identifier: Apache-2.0
// Texels as flatten lays them out and kernels/scene/texture.h reads them, against straightforward double arithmetic.
#include "flatten/textures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "flatten/half.h"
#include "flatten/tables.h"
#include "host/flatten/flatten_support.h"
#include "math/vector.h"
#include "scene/texture.h"

namespace sunstone {
namespace {

double reference_half(std::uint32_t h) {
  const int exponent = static_cast<int>(h >> 10 & 31), mantissa = static_cast<int>(h & 1023);
  double value = exponent == 0 ? std::ldexp(mantissa, -24) : exponent < 31 ? std::ldexp(1024 + mantissa, exponent - 25) : mantissa ? NAN : INFINITY;
  return h & 0x8000 ? -value : value;
}

TEST(Half, EveryOneIsDecoded) {
  for (std::uint32_t h = 0; h < 65536; h++) {
    const double expected = reference_half(h);
    const float host = float_from_half(static_cast<std::uint16_t>(h)), kernels = kernel::float_of_half(h);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(host) && std::isnan(kernels));
      continue;
    }
    ASSERT_EQ(host, expected) << h;
    ASSERT_EQ(kernels, expected) << h;
    ASSERT_EQ(std::signbit(kernels), std::signbit(expected)) << h;
    ASSERT_EQ(half_from_float(host), h);
  }
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
  // Between any two neighbours: just below, at and just above the middle.
  for (std::uint32_t h = 0; h < 0x7bff; h++) {
    const double middle = (reference_half(h) + reference_half(h + 1)) / 2;
    const auto tie = static_cast<float>(middle);
    ASSERT_EQ(static_cast<double>(tie), middle);
    ASSERT_EQ(half_from_float(tie), h % 2 ? h + 1 : h) << h;
    ASSERT_EQ(half_from_float(std::nextafter(tie, 0.0f)), h) << h;
    ASSERT_EQ(half_from_float(std::nextafter(tie, INFINITY)), h + 1) << h;
    ASSERT_EQ(half_from_float(-tie), 0x8000u | (h % 2 ? h + 1 : h)) << h;
  }
  EXPECT_EQ(half_from_float(65519.996f), 0x7bff);
  EXPECT_EQ(half_from_float(65520.0f), 0x7c00);
}

TEST(Textures, SrgbTableIsTheStandardsCurve) {
  const std::vector<float> tables = make_tables();
  for (int byte = 0; byte < 256; byte++) {
    const double x = byte / 255.0, expected = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(tables[static_cast<std::size_t>(SUN_TABLE_SRGB + byte)], expected, 5e-7 * expected + 1e-9) << byte;
  }
}

// A scene with one square that shows these textures as base colour (colour) and metallic-roughness (data).
Scene textured_scene(Image image, Texture texture) {
  Scene scene = scene_of(square(0));
  scene.images.push_back(std::move(image));
  texture.image = 0;
  scene.textures.push_back(texture);
  Material material;
  material.base_color_texture.texture = 0;
  material.metallic_roughness_texture.texture = 0;
  scene.materials.push_back(material);
  return scene;
}

kernel::TexturePages pages_of(const FlatScene &flat) {
  kernel::TexturePages pages;
  for (std::size_t i = 0; i < SUN_TEXTURE_PAGES; i++) pages.page[i] = flat.texel_pages[i].data();
  return pages;
}

// The i-th image value of a channel as the slot should see it.
double reference_texel(const Image &image, int x, int y, int channel, bool color) {
  const int spread = image.channels < 3 ? (channel < 3 ? 0 : 1) : channel;
  if (spread >= image.channels) return 1;
  const auto at = static_cast<std::size_t>((y * image.width + x) * image.channels + spread);
  if (image.is_float()) return std::get<1>(image.pixels)[at];
  const double v = std::get<0>(image.pixels)[at] / 255.0;
  if (!color || channel == 3) return v;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

int wrapped(long i, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::min(std::max(i, 0l), size - 1l));
  if (wrap == Wrap::repeat) return static_cast<int>(((i % size) + size) % size);
  const long period = ((i % (2l * size)) + 2l * size) % (2l * size);
  return static_cast<int>(period < size ? period : 2l * size - 1 - period);
}

double reference_sample(const Image &image, const Texture &texture, bool color, int channel, double u, double v) {
  if (!texture.linear) {
    const int x = wrapped(static_cast<long>(std::floor(u * image.width)), image.width, texture.wrap_u);
    return reference_texel(image, x, wrapped(static_cast<long>(std::floor(v * image.height)), image.height, texture.wrap_v), channel, color);
  }
  const double x = u * image.width - 0.5, y = v * image.height - 0.5;
  const long x0 = static_cast<long>(std::floor(x)), y0 = static_cast<long>(std::floor(y));
  double sum = 0;
  for (int dy = 0; dy < 2; dy++)
    for (int dx = 0; dx < 2; dx++) {
      const double weight = (dx ? x - double(x0) : 1 - (x - double(x0))) * (dy ? y - double(y0) : 1 - (y - double(y0)));
      sum += weight *
             reference_texel(image, wrapped(x0 + dx, image.width, texture.wrap_u), wrapped(y0 + dy, image.height, texture.wrap_v), channel, color);
    }
  return sum;
}

void expect_agreement(const Image &image, const Texture &texture, double tolerance) {
  const FlatScene flat = flattened(textured_scene(image, texture));
  ASSERT_EQ(flat.textures.size(), 2u);
  const kernel::TexturePages pages = pages_of(flat);
  Random random(11);
  for (int i = 0; i < 2000; i++) {
    const float u = random.between(-3, 3), v = random.between(-3, 3);
    if (!texture.linear) {  // a number on the edge of two texels may go either way
      const double x = double(u) * image.width, y = double(v) * image.height;
      if (std::fabs(x - std::round(x)) < 1e-4 || std::fabs(y - std::round(y)) < 1e-4) continue;
    }
    for (bool color : {true, false}) {
      const kernel::uint ref = flat.materials[0].slot[color ? SUN_SLOT_BASE_COLOR : SUN_SLOT_METALLIC_ROUGHNESS];
      const float uv[2] = {u, v}, other[2] = {0, 0};
      const kernel::Texel4 texel = kernel::sample_slot(&pages, flat.textures.data(), flat.texture_refs.data(), flat.tables.data(), ref, uv, other, 1);
      const float value[4] = {texel.r, texel.g, texel.b, texel.a};
      for (int c = 0; c < 4; c++)
        ASSERT_NEAR(value[c], reference_sample(image, texture, color, c, u, v), tolerance) << u << " " << v << " channel " << c;
    }
  }
}

TEST(Textures, EveryWrapFilterAndNumberOfChannelsAgreesWithTheReference) {
  for (Wrap wrap_u : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
    for (Wrap wrap_v : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
      for (bool linear : {true, false}) expect_agreement(byte_image(7, 5, 4, 3), {0, wrap_u, wrap_v, linear}, 1e-5);
  for (int channels : {1, 2, 3}) expect_agreement(byte_image(4, 9, channels, 4), {}, 1e-5);
  for (Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) expect_agreement(byte_image(1, 1, 3, 5), {0, wrap, wrap, true}, 1e-5);
}

TEST(Textures, FloatImages) {
  Random random(5);
  std::vector<float> halves(3 * 6 * 4), others(3 * 6 * 4);
  for (float &x : halves) x = float_from_half(static_cast<std::uint16_t>(random.bits() % 0x5000));
  for (float &x : others) x = random.between(0, 30);
  expect_agreement(float_image(6, 4, 3, halves), {}, 1e-4);
  const FlatScene exact = flattened(textured_scene(float_image(6, 4, 3, halves), {}));
  EXPECT_EQ(exact.textures[1].format, kernel::uint(SUN_TEXEL_RGBA16F));
  // Colours are rounded to halves, data that are no halves stay floats.
  const FlatScene rounded = flattened(textured_scene(float_image(6, 4, 3, others), {}));
  EXPECT_EQ(rounded.textures[0].format, kernel::uint(SUN_TEXEL_RGBA16F));
  EXPECT_EQ(rounded.textures[1].format, kernel::uint(SUN_TEXEL_RGBA32F));
  expect_agreement(float_image(6, 4, 3, others), {}, 30 * 0x1p-11);
  others[5] = 1e5f;
  EXPECT_EQ(flattened(textured_scene(float_image(6, 4, 3, others), {})).textures[0].format, kernel::uint(SUN_TEXEL_RGBA32F));
}

TEST(Textures, SixteenBitIntegersAreSrgbAsColours) {
  std::vector<float> values;
  for (int i = 0; i < 12; i++) values.push_back(static_cast<float>(i * 5957) / 65535.0f);
  const FlatScene flat = flattened(textured_scene(float_image(2, 2, 3, values), {}));
  const float encoded = values[4], linear = std::pow((encoded + 0.055f) / 1.055f, 2.4f);
  EXPECT_NEAR(read_texel(flat, flat.textures[0], 1, 0)[1], linear, linear * 0x1p-11f);
  EXPECT_EQ(read_texel(flat, flat.textures[1], 1, 0)[1], encoded);
}

TEST(Textures, ValuesThatAreNotFiniteBecomeZeroWithAWarning) {
  Notices notices;
  const FlatScene flat = flatten(textured_scene(float_image(2, 1, 3, {NAN, 1.5f, 2, INFINITY, -1, 4}), {}), {}, notices);
  EXPECT_EQ(notices.all().size(), 1u);
  EXPECT_EQ(read_texel(flat, flat.textures[0], 0, 0)[0], 0.0f);
  EXPECT_EQ(read_texel(flat, flat.textures[0], 1, 0)[0], 0.0f);
  EXPECT_EQ(read_texel(flat, flat.textures[0], 1, 0)[1], 0.0f);   // no colour is negative
  EXPECT_EQ(read_texel(flat, flat.textures[1], 1, 0)[1], -1.0f);  // data may be
}

TEST(Textures, BadCoordinatesStayInside) {
  const FlatScene flat = flattened(textured_scene(byte_image(3, 3, 3, 1), {}));
  const kernel::TexturePages pages = pages_of(flat);
  for (float u : {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, -1e-20f, 1.0f, -0.0f, 3e9f})
    for (kernel::uint wrap : {SUN_WRAP_REPEAT, SUN_WRAP_MIRROR, SUN_WRAP_CLAMP})
      for (kernel::uint linear : {0u, 1u}) {
        kernel::Texture texture = flat.textures[0];
        texture.wrap_u = texture.wrap_v = wrap;
        texture.linear = linear;
        const kernel::Texel4 texel = kernel::sample_texture(&pages, &texture, flat.tables.data(), 0, u, u, 1);
        EXPECT_TRUE(texel.r >= 0 && texel.r <= 1) << u;
      }
}

TEST(Textures, NoTextureAndUnwantedLanesAreWhite) {
  const kernel::TexturePages pages{};
  const float uv[2] = {0, 0};
  EXPECT_EQ(kernel::sample_slot(&pages, nullptr, nullptr, nullptr, SUN_NONE, uv, uv, 1).g, 1.0f);
  EXPECT_EQ(kernel::sample_slot(&pages, nullptr, nullptr, nullptr, 0, uv, uv, 0).a, 1.0f);
}

TEST(Textures, TransformsAndSecondSetsAreApplied) {
  Scene scene = textured_scene(byte_image(8, 8, 3, 2), {0, Wrap::repeat, Wrap::repeat, false});
  scene.meshes[0].primitives[0].uv[1].assign(4, glm::vec2(0.3f));
  TextureUse &use = scene.materials[0].base_color_texture;
  use.uv_set = 1;
  use.transform = glm::mat3x2(0, 2, -1, 0, 0.25f, 0.125f);  // u' = -v + 0.25, v' = 2 u + 0.125
  const FlatScene flat = flattened(scene);
  const kernel::TexturePages pages = pages_of(flat);
  const float unused[2] = {0.9f, 0.9f}, uv[2] = {0.2f, 0.6f};
  const kernel::Texel4 texel = kernel::sample_slot(&pages, flat.textures.data(), flat.texture_refs.data(), flat.tables.data(),
                                                   flat.materials[0].slot[SUN_SLOT_BASE_COLOR], unused, uv, 1);
  EXPECT_NEAR(texel.g, reference_sample(scene.images[0], scene.textures[0], true, 1, -0.6 + 0.25, 0.4 + 0.125), 1e-6);
}

TEST(Textures, AnImageUsedBothWaysIsStoredOnce) {
  const FlatScene flat = flattened(textured_scene(byte_image(16, 16, 3, 2), {}));
  ASSERT_EQ(flat.textures.size(), 2u);
  EXPECT_EQ(flat.texel_pages[0].size(), 256u);
  EXPECT_EQ(flat.textures[0].offset, flat.textures[1].offset);
  EXPECT_NE(flat.textures[0].format, flat.textures[1].format);
}

TEST(Textures, PagesAreFilledInOrderAndEndInAnError) {
  Scene scene = scene_of(square(0));
  for (int i = 0; i < 4; i++) {
    scene.images.push_back(byte_image(16, 16, 3, static_cast<std::uint32_t>(i)));
    scene.textures.push_back({i});
  }
  Material &material = scene.materials.emplace_back();
  material.base_color_texture.texture = 0;
  material.metallic_roughness_texture.texture = 1;
  material.normal_texture.texture = 2;
  material.specular_texture.texture = 3;
  FlattenOptions options;
  options.max_page_bytes = 1024;  // one image each
  const FlatScene flat = flattened(scene, options);
  for (std::size_t i = 0; i < 4; i++) EXPECT_EQ(flat.texel_pages[i].size(), 256u);
  EXPECT_EQ(flat.scene_hash, flattened(scene).scene_hash);  // where they lie is no part of the scene
  options.max_page_bytes = 1023;
  EXPECT_THROW(flattened(scene, options), Error);
}

}  // namespace
TEST(Texels, BytesAreQuotientsToTheBit) {
  for (unsigned byte = 0; byte < 256; byte++) EXPECT_EQ(kernel::level_of_byte(byte), static_cast<float>(byte) / 255.0f) << byte;
}

}  // namespace sunstone
