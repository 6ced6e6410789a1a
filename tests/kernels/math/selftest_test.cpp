// SPDX-License-Identifier: Apache-2.0
// The self-test passes on a good device, remembers its verdict, and does not trust a damaged memory.
#include "device/selftest.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>

#include "base/cache.h"
#include "device/kernel.h"

namespace sunstone {
namespace {

class SelfTest : public testing::Test {
 protected:
  void SetUp() override {
    Notices notices;
    const auto devices = list_devices(notices);
    if (devices.empty()) GTEST_SKIP() << "no OpenCL device";
    const char *selector = std::getenv("SUNSTONE_TEST_DEVICE");  // as --device; default: the device that a render would take
    device_ = Device(choose_device(devices, selector ? selector : ""), {});
    folder_ = std::filesystem::temp_directory_path() / ("sunstone-selftest-" + std::to_string(::getpid()));
    setenv("SUNSTONE_CACHE", folder_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("SUNSTONE_CACHE");
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  // The one verdict that the folder holds.
  std::filesystem::path entry() const {
    for (const auto &file : std::filesystem::directory_iterator(folder_))
      if (file.path().filename().string().starts_with("selftest-")) return file.path();
    return {};
  }
  Device device_;
  std::filesystem::path folder_;
};

TEST_F(SelfTest, ThisDeviceGivesTheHostsBits) {
  const SelfTestResult result = self_test(device_);
  EXPECT_TRUE(result.reproducible) << result.differs;
  EXPECT_EQ(result.differs, "");
  std::cout << device_.info().description() << ": " << result.seconds << " s\n";
}

TEST_F(SelfTest, RemembersItsVerdict) {
  EXPECT_GT(cached_self_test(device_).seconds, 0);
  const SelfTestResult again = cached_self_test(device_);
  EXPECT_EQ(again.seconds, 0);
  EXPECT_TRUE(again.reproducible);
}

TEST_F(SelfTest, RedoesADamagedEntry) {
  cached_self_test(device_);
  const auto path = entry();
  ASSERT_FALSE(path.empty());
  const auto size = std::filesystem::file_size(path);
  for (const std::string damage : {"flipped", "cut", "empty"}) {
    if (damage == "flipped") {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(static_cast<std::streamoff>(size) - 1);
      file.put('n');
    } else {
      std::filesystem::resize_file(path, damage == "cut" ? size - 1 : 0);
    }
    const SelfTestResult result = cached_self_test(device_);
    EXPECT_GT(result.seconds, 0) << damage;
    EXPECT_TRUE(result.reproducible) << damage;
    EXPECT_EQ(std::filesystem::file_size(path), size) << damage;
  }
}

// Entries that are whole but say what they should not, and a bad verdict, which is remembered as well as a good one.
TEST_F(SelfTest, ReadsOnlyVerdicts) {
  cached_self_test(device_);
  const std::string hex = entry().stem().string().substr(std::string("selftest-").size());
  ASSERT_EQ(hex.size(), 32u);
  const Hash key{std::stoull(hex.substr(0, 16), nullptr, 16), std::stoull(hex.substr(16), nullptr, 16)};
  const auto write = [&](const std::string &text) { cache_write("selftest", key, std::as_bytes(std::span(text))); };
  for (const std::string text : {"", "yes", "n", "ndivide", "nnonsense (lanes 1)", "Y"}) {
    write(text);
    const SelfTestResult result = cached_self_test(device_);
    EXPECT_GT(result.seconds, 0) << text;
    EXPECT_TRUE(result.reproducible) << text;
  }
  write("ndivide (lanes 16)");
  const SelfTestResult result = cached_self_test(device_);
  EXPECT_FALSE(result.reproducible);
  EXPECT_EQ(result.differs, "divide (lanes 16)");
}

}  // namespace
}  // namespace sunstone
