// SPDX-License-Identifier: Apache-2.0
// kernels/math and the film on a device: the host's bits at every width, and sums that stand any amount of contention, by both kinds of atomics.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "device/buffer.h"
#include "device/device.h"
#include "device/kernel.h"
#include "device/program.h"
#include "device/source.h"
#include "math/selftest.h"
#include "path/film.h"

namespace sunstone {
namespace {

std::string probe(const std::string &name) {
  std::ifstream file(std::string(SUNSTONE_SOURCE_DIR) + "/tests/kernels/probes/" + name);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_FALSE(text.str().empty()) << name;
  return text.str();
}

struct Section {
  const char *name;
  kernel::uint (*of)(const kernel::TestInputs *in);
  kernel::uint run(kernel::uint i) const {
    const kernel::TestInputs in = kernel::test_inputs(i);
    return of(&in);
  }
};
constexpr Section sections[] = {
#define SUN_SECTION(name) {#name, kernel::test_of_##name},
    SUN_SELFTEST_SECTIONS(SUN_SECTION)
#undef SUN_SECTION
};

class MathDevice : public testing::Test {
 protected:
  void SetUp() override {
    Notices notices;
    const auto devices = list_devices(notices);
    if (devices.empty()) GTEST_SKIP() << "no OpenCL device";
    const char *selector = std::getenv("SUNSTONE_TEST_DEVICE");  // as --device; default: the device that a render would take
    device_ = Device(choose_device(devices, selector ? selector : ""), {});
  }
  // What a program made of `text` says to every input of every section.
  std::vector<kernel::uint> results(const std::string &text, int lanes) const {
    const Program program = Program::from_text(device_, "sections.cl", text, {{"LANES", lanes}});
    const Buffer<kernel::uint> words(device_, std::size(sections) * SUN_SELFTEST_INPUTS, "results");
    Kernel run(program, "sections");
    run.run(SUN_SELFTEST_INPUTS / static_cast<std::size_t>(lanes), words);
    return words.download();
  }
  Device device_;
};

class MathDeviceLanes : public MathDevice, public testing::WithParamInterface<int> {};

TEST_P(MathDeviceLanes, GivesTheHostsBits) {
  const auto words = results(probe("sections.cl"), GetParam());
  for (std::size_t s = 0; s < std::size(sections); s++) {
    std::vector<kernel::uint> wrong;
    for (kernel::uint i = 0; i < SUN_SELFTEST_INPUTS; i++)
      if (words[s * SUN_SELFTEST_INPUTS + i] != sections[s].run(i)) wrong.push_back(i);
    EXPECT_TRUE(wrong.empty()) << sections[s].name << ": " << wrong.size() << " of " << SUN_SELFTEST_INPUTS << " differ, the first at input "
                               << wrong.front();
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, MathDeviceLanes, testing::Values(1, 8, 16));

// A compiler that fuses a * b + c is found out, by name, so the sections can tell.
TEST_F(MathDevice, FusedArithmeticIsFoundOut) {
  if (!device_.info().cpu) GTEST_SKIP() << "whether other devices fuse by default is not known";
  std::string text = resolve_includes(probe("sections.cl"), "sections.cl");
  const std::string pragma = "#pragma OPENCL FP_CONTRACT OFF";
  const auto at = text.find(pragma);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, pragma.size(), "#pragma OPENCL FP_CONTRACT ON");
  const auto words = results(text, 1);
  bool unfused_differs = false, integers_differ = false;
  for (std::size_t s = 0; s < std::size(sections); s++)
    for (kernel::uint i = 0; i < SUN_SELFTEST_INPUTS; i++) {
      if (words[s * SUN_SELFTEST_INPUTS + i] == sections[s].run(i)) continue;
      if (std::string(sections[s].name) == "unfused") unfused_differs = true;
      if (std::string(sections[s].name) == "integers") integers_differ = true;
    }
  EXPECT_TRUE(unfused_differs);
  EXPECT_FALSE(integers_differ);
}

// As probes/film.cl makes them.
float probe_value(kernel::uint n, kernel::uint channel) {
  const kernel::uint h = kernel::hash3_1(n, channel, 99);
  return kernel::as_float((h & 0x807fffffu) | ((n % 1009u == 7u ? 255u : 90u + kernel::hash2_1(h, 3) % 65u) << 23));
}

struct FilmCase {
  int lanes, atomics_64;
};
class FilmDevice : public MathDevice, public testing::WithParamInterface<FilmCase> {
 protected:
  void SetUp() override {
    MathDevice::SetUp();
    if (IsSkipped()) return;
    if (GetParam().atomics_64 && !device_.info().atomics_64) GTEST_SKIP() << "no 64-bit atomics here";
  }
  Program program() const {
    return Program::from_text(device_, "film.cl", probe("film.cl"), {{"LANES", GetParam().lanes}, {"SUN_ATOMICS_64", GetParam().atomics_64}});
  }
};

TEST_P(FilmDevice, SumsUnderContention) {
  constexpr kernel::uint pixels = 3, layers = 2, total = 1 << 18;
  constexpr std::size_t size = layers * pixels * SUN_FILM_CHANNELS * SUN_FILM_BINS;
  std::vector<long> want(size);
  std::vector<kernel::uint> want_counts(SUN_COUNT_WORDS);
  const kernel::FilmView view{want.data(), pixels, want_counts.data()};
  for (kernel::uint n = 0; n < total; n++)
    if (n % 5 != 0)
      kernel::film_add(&view, n & 1, n % pixels, kernel::hash2(n, 4), n >> 3, SUN_FILM_KEY_EMISSION(n & 3),
                       probe_value(n, 0), probe_value(n, 1), probe_value(n, 2));
  ASSERT_GT(want_counts[SUN_COUNT_CLAMPED], 0u);
  ASSERT_GT(want_counts[SUN_COUNT_NAN], 0u);

  const Buffer<long> words(device_, size, "film");
  const Buffer<kernel::uint> counts(device_, SUN_COUNT_WORDS, "counts");
  words.fill_zero();
  counts.fill_zero();
  Kernel add(program(), "film_contributions");
  add.run(total / static_cast<kernel::uint>(GetParam().lanes), words, counts, pixels, total);
  EXPECT_EQ(words.download(), want);
  EXPECT_EQ(counts.download(), want_counts);
}

TEST_P(FilmDevice, CarriesAndBorrows) {
  constexpr kernel::uint total = 1 << 19;
  std::vector<long> want(4);
  for (kernel::uint n = 0; n < total; n++) {
    const long size = static_cast<long>((static_cast<kernel::ulong>(kernel::hash2_1(n, 1)) << 16) | (kernel::hash2_1(n, 2) & 0xffffu));
    want[n % 3] += n & 1 ? size : -size;
    want[3] += n & 1 ? 1 : -1;
  }
  const Buffer<long> words(device_, want.size(), "film");
  words.fill_zero();
  Kernel add(program(), "film_words");
  add.run(total, words, total);
  EXPECT_EQ(words.download(), want);
}

INSTANTIATE_TEST_SUITE_P(Atomics, FilmDevice, testing::Values(FilmCase{1, 0}, FilmCase{1, 1}, FilmCase{16, 0}, FilmCase{16, 1}),
                         [](const auto &info) {
                           return "Lanes" + std::to_string(info.param.lanes) + "Atomics" + (info.param.atomics_64 ? "64" : "32");
                         });

}  // namespace
}  // namespace sunstone
