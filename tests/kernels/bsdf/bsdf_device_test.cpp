// SPDX-License-Identifier: Apache-2.0
// The BSDF on every device that there is, at LANES 1, 8 and 16: the same bits as the kernels' headers compiled as C++, for random materials and
// directions.
#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "base/file.h"
#include "device/buffer.h"
#include "device/device.h"
#include "device/kernel.h"
#include "device/program.h"
#include "kernels/bsdf/materials.h"

namespace sunstone::test {
namespace {

constexpr std::size_t count = 131'072, in_columns = 22, out_columns = 18;

// Columns of inputs: every kind of material, limits included, and directions that matter to it.
std::vector<float> random_inputs(const std::vector<float> &tables) {
  std::vector<float> in(in_columns * count);
  Random random(77);
  const auto extreme = [&] {
    const float choice = random.unit();
    return choice < 0.25f ? 0.0f : choice < 0.5f ? 1.0f : random.unit();
  };
  const float alphas[] = {0.0f, 0.001f, 0.02f, 0.1f, 0.3f, 1.0f}, etas[] = {0.41f, 0.6666667f, 0.99995f, 1.0f, 1.02f, 1.33f, 1.5f, 2.42f};
  for (std::size_t i = 0; i < count; i++) {
    Bsdf b{};
    b.base = make_vec3(random.unit(), extreme(), random.unit());
    b.metallic = extreme(), b.transmission = extreme();
    b.alpha = random.unit() < 0.5f ? alphas[random.bits() % std::size(alphas)] : random.unit();
    b.f0 = make_vec3(0.1f * random.unit(), extreme(), 0.04f), b.f90 = extreme();
    b.eta = etas[random.bits() % std::size(etas)];
    b.solid = int(random.bits() & 1), b.specular = random.unit() < 0.8f;
    // Groups of 16 alike every now and then, so that branches on ANY are taken both ways.
    if (i / 16 % 4 == 0) b.specular = 0;
    if (i / 16 % 4 == 1) b.solid = 0;
    const vec3 wo = direction(std::max(random.unit(), 1e-4f), 6.2f * random.unit());
    vec3 wi = direction(std::max(random.unit(), 1e-4f), 6.2f * random.unit());
    const float u = random.unit(), v = random.unit(), w = random.unit();
    if (random.bits() & 1) wi = flip(wi);
    else if (random.bits() & 1) {
      const BsdfSample s = bsdf_sample(&b, tables.data(), wo, random.unit(), 0.3f, 0.8f);
      if (s.valid) wi = s.wi;
    }
    const float values[in_columns] = {b.base.x, b.base.y, b.base.z, b.metallic, b.alpha, b.f0.x, b.f0.y, b.f0.z, b.f90, b.transmission, b.eta,
                                      float(b.solid), float(b.specular), wo.x, wo.y, wo.z, wi.x, wi.y, wi.z, u, v, w};
    for (std::size_t column = 0; column < in_columns; column++) in[column * count + i] = values[column];
  }
  return in;
}

std::vector<float> on_the_host(const std::vector<float> &tables, const std::vector<float> &in) {
  std::vector<float> out(out_columns * count);
  for (std::size_t i = 0; i < count; i++) {
    const auto at = [&](std::size_t column) { return in[column * count + i]; };
    Bsdf b{};
    b.base = make_vec3(at(0), at(1), at(2));
    b.metallic = at(3), b.alpha = at(4);
    b.f0 = make_vec3(at(5), at(6), at(7));
    b.f90 = at(8), b.transmission = at(9), b.eta = at(10);
    b.solid = at(11) > 0.0f, b.inside = b.eta < 1.0f, b.specular = at(12) > 0.0f;
    const vec3 wo = make_vec3(at(13), at(14), at(15)), wi = make_vec3(at(16), at(17), at(18));
    const BsdfEval e = bsdf_eval(&b, tables.data(), wo, wi);
    const BsdfSample s = bsdf_sample(&b, tables.data(), wo, at(19), at(20), at(21));
    const vec3 albedo = bsdf_albedo(&b, tables.data(), wo), straight = bsdf_straight(&b, wo);
    const float flags = float(s.delta != 0) + 2.0f * float(s.valid != 0) + 4.0f * float(s.transmitted != 0);
    const float values[out_columns] = {e.f_cos.x, e.f_cos.y, e.f_cos.z, e.pdf, s.wi.x, s.wi.y, s.wi.z, s.weight.x, s.weight.y, s.weight.z,
                                       s.pdf, flags, albedo.x, albedo.y, albedo.z, straight.x, straight.y, straight.z};
    for (std::size_t column = 0; column < out_columns; column++) out[column * count + i] = values[column];
  }
  return out;
}

TEST(BsdfDevice, SameBitsAsTheHostAtEveryWidth) {
  const std::vector<float> tables = make_tables(), in = random_inputs(tables), expected = on_the_host(tables, in);
  const std::vector<std::byte> bytes = read_file(SUNSTONE_SOURCE_DIR "/tests/kernels/probes/bsdf.cl");
  const std::string text(reinterpret_cast<const char *>(bytes.data()), bytes.size());
  Notices notices;
  int devices = 0;
  for (const DeviceInfo &info : list_devices(notices)) {
    if (!info.available) continue;
    devices++;
    const Device device(info, {});
    const Buffer<float> tables_buffer(device, std::span(tables), "tables"), in_buffer(device, std::span(in), "in");
    const Buffer<float> out_buffer(device, expected.size(), "out");
    for (const int lanes : {1, 8, 16}) {
      const Program program = Program::from_text(device, "bsdf.cl", text, {{"LANES", lanes}});
      out_buffer.fill_zero();
      Kernel(program, "bsdf").run(count / std::size_t(lanes), uint(count), tables_buffer, in_buffer, out_buffer);
      const std::vector<float> out = out_buffer.download();
      std::size_t different = 0, first = 0;
      for (std::size_t i = 0; i < out.size(); i++)
        if (std::bit_cast<std::uint32_t>(out[i]) != std::bit_cast<std::uint32_t>(expected[i])) {
          if (different++ == 0) first = i;
        }
      EXPECT_EQ(different, 0u) << info.name << ", LANES " << lanes << ": first in column " << first / count << " of input " << first % count << ": "
                               << out[first] << " for " << expected[first];
    }
  }
  if (devices == 0) GTEST_SKIP() << "no OpenCL device";
}

}  // namespace
}  // namespace sunstone::test
