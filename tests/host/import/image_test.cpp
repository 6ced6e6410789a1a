// SPDX-License-Identifier: Apache-2.0
// --env: three numbers, or a picture; every broken environment map of the shared scenes.
#include <chrono>
#include <cmath>

#include "host/import/obj_files.h"

using namespace sunstone;
using namespace sunstone::test;

namespace {

struct Read {
  Environment environment;
  std::string error;
  std::vector<Notice> notices;
};

Read read(const std::string &text) {
  Read out;
  Notices notices;
  try {
    out.environment = import_environment(text, notices);
  } catch (const Error &error) {
    out.error = error.what();
  }
  out.notices = notices.all();
  return out;
}

}  // namespace

TEST(Environment, ThreeNumbersAreAConstant) {
  Notices notices;
  const Environment e = import_environment("1, 2.5,0", notices);
  EXPECT_EQ(e.kind, Environment::Kind::constant);
  EXPECT_EQ(e.constant, glm::vec3(1, 2.5f, 0));
  for (const char *bad : {"1,2", "1,2,3,4", "1,2,-3", "1,2,nan", "1,2,inf", "1,2,1e99", "a,b,c"})
    EXPECT_THROW(import_environment(bad, notices), UsageError) << bad;
  for (const char *missing : {"", "no-such-picture.hdr"}) EXPECT_THROW(import_environment(missing, notices), Error) << missing;
}

TEST(Environment, MapsOfTheSharedScenesEndAsTheirTableSays) {
  const std::filesystem::path folder = scenes() / "malformed";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not here: " << folder;
  const auto start = std::chrono::steady_clock::now();
  for (const char *valid : {"valid-env-one-bright-pixel.hdr", "env-all-black.hdr"}) {
    const Read r = read((folder / valid).string());
    EXPECT_EQ(r.error, "") << valid;
    EXPECT_TRUE(r.notices.empty()) << valid;
    ASSERT_EQ(r.environment.kind, Environment::Kind::map);
    EXPECT_EQ(r.environment.map->channels, 3);
  }
  const std::pair<const char *, const char *> refused[] = {
      {"env-truncated.hdr", "cut off"},  {"env-zero-by-zero.hdr", "0 x 0"}, {"env-huge-size.hdr", "2000000 x 1000000"},
      {"env-rle-overrun.hdr", "broken"}, {"env-truncated.exr", "cut off"},  {"env-huge-window.exr", "2147483647 x 2147483647"},
  };
  for (const auto &[name, text] : refused) {
    const Read r = read((folder / name).string());
    EXPECT_NE(r.error.find(text), std::string::npos) << name << ": " << r.error;
    EXPECT_NE(r.error.find(name), std::string::npos) << r.error;
  }
  const Read bad = read((folder / "env-nan-and-negative.exr").string());
  EXPECT_EQ(bad.error, "");
  ASSERT_EQ(bad.notices.size(), 1u);
  EXPECT_EQ(bad.notices[0].text, "values treated as 0: 3 NaN, 3 infinite, 48 negative");
  for (const float v : std::get<std::vector<float>>(bad.environment.map->pixels)) EXPECT_TRUE(v >= 0 && std::isfinite(v));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5.0);
}

TEST(Environment, GoodMapsAreRead) {
  const std::filesystem::path folder = scenes() / "env";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not here: " << folder;
  const struct {
    const char *name;
    int width;
    float largest;  // as the folder's README has it
  } maps[] = {
      {"venice_sunset_1k.hdr", 1024, 6496}, {"studio_small_03_1k.hdr", 1024, 3568}, {"forest.exr", 1024, 1010}, {"courtyard_512.exr", 512, 0}};
  for (const auto &m : maps) {
    const Read r = read((folder / m.name).string());
    ASSERT_EQ(r.error, "") << m.name;
    EXPECT_EQ(r.environment.map->width, m.width);
    EXPECT_EQ(r.environment.map->height, m.width / 2);
    float largest = 0;
    for (const float v : std::get<std::vector<float>>(r.environment.map->pixels)) largest = std::max(largest, v);
    if (m.largest > 0) {
      EXPECT_NEAR(largest, m.largest, 1 + m.largest * 0.01f) << m.name;
    }
  }
}
