// SPDX-License-Identifier: Apache-2.0
#include "device/selftest.h"

#include <array>
#include <chrono>
#include <cstring>
#include <optional>
#include <vector>

#include "base/cache.h"
#include "device/buffer.h"
#include "device/kernel.h"
#include "device/program.h"
#include "device/source.h"
#include "math/selftest.h"

namespace sunstone {

namespace {

constexpr const char *source_name = "stages/selftest.cl";
constexpr const char *cache_kind = "selftest";
constexpr std::size_t items = 64;  // SUN_SELFTEST_ITEMS of stages/selftest.cl

struct Section {
  const char *name;
  kernel::uint (*run)(const kernel::TestInputs *in);
};

constexpr Section sections[] = {
#define SUN_SECTION(name) {#name, kernel::test_of_##name},
    SUN_SELFTEST_SECTIONS(SUN_SECTION)
#undef SUN_SECTION
};
constexpr std::size_t section_count = std::size(sections);

// What each section adds up to where arithmetic is as it should be.
std::array<kernel::uint, section_count> host_sums() {
  std::array<kernel::uint, section_count> sums{};
  for (kernel::uint i = 0; i < SUN_SELFTEST_INPUTS; i++) {
    const kernel::TestInputs in = kernel::test_inputs(i);
    for (std::size_t s = 0; s < section_count; s++) sums[s] += kernel::test_term(i, sections[s].run(&in));
  }
  return sums;
}

// The widths that this device may be asked to render with.
std::vector<int> widths(const DeviceInfo &info) {
  if (info.cpu && info.native_float_width >= 8) return {1, 16};
  return {1};
}

std::array<kernel::uint, section_count> device_sums(const Device &device, int lanes) {
  const Program program(device, source_name, {{"LANES", lanes}});
  const Buffer<kernel::uint> buffer(device, section_count * items, "self-test");
  buffer.fill_zero();
  Kernel run(program, "selftest");
  run.run(items, buffer);
  const std::vector<kernel::uint> parts = buffer.download();
  std::array<kernel::uint, section_count> sums{};
  for (std::size_t at = 0; at < parts.size(); at++) sums[at / items] += parts[at];
  return sums;
}

Hash key_of(const DeviceInfo &info) {
  Hasher hasher;
  hasher.add(resolve_includes(embedded_source(source_name), source_name));
  for (const std::string &part : {info.platform, info.name, info.vendor, info.driver, info.version}) hasher.add(part);
  for (const int lanes : widths(info)) hasher.value(lanes);
  hasher.value(static_cast<std::uint32_t>(info.correct_divide_sqrt));  // becomes a build option
  return hasher.digest();
}

// An entry is 'y', or 'n' and what differs.
std::optional<SelfTestResult> read_verdict(std::span<const std::byte> entry) {
  const std::string_view text(reinterpret_cast<const char *>(entry.data()), entry.size());
  if (text == "y") return SelfTestResult{true, {}, 0};
  if (!text.starts_with('n')) return std::nullopt;
  for (const Section &section : sections)
    for (const int lanes : {1, 16}) {
      const std::string differs = std::string(section.name) + " (lanes " + std::to_string(lanes) + ")";
      if (text.substr(1) == differs) return SelfTestResult{false, differs, 0};
    }
  return std::nullopt;
}

}  // namespace

SelfTestResult self_test(const Device &device) {
  const auto start = std::chrono::steady_clock::now();
  const auto expected = host_sums();
  SelfTestResult result;
  for (const int lanes : widths(device.info())) {
    if (!result.differs.empty()) break;
    const auto sums = device_sums(device, lanes);
    for (std::size_t s = 0; s < section_count && result.differs.empty(); s++)
      if (sums[s] != expected[s]) result.differs = std::string(sections[s].name) + " (lanes " + std::to_string(lanes) + ")";
  }
  result.reproducible = result.differs.empty();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

SelfTestResult cached_self_test(const Device &device) {
  const Hash key = key_of(device.info());
  if (const auto entry = cache_read(cache_kind, key))
    if (const auto verdict = read_verdict(*entry)) return *verdict;
  const SelfTestResult result = self_test(device);
  const std::string text = result.reproducible ? "y" : "n" + result.differs;
  cache_write(cache_kind, key, std::as_bytes(std::span(text)));
  return result;
}

}  // namespace sunstone
