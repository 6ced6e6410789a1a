// SPDX-License-Identifier: Apache-2.0
// compare and merge as the command line calls them.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "cli/commands.h"
#include "content/content.h"
#include "film/film_file.h"
#include "host/film/made_film.h"
#include "support/temporary_folder.h"

namespace sunstone {

// The library is linked here, not opened.
const Content &load_content() {
  static const Content content = [] {
    Content table{};
    table.write_picture = write_picture;
    table.compare_images = compare_images;
    table.read_picture = read_picture;
    return table;
  }();
  return content;
}

using nlohmann::json;
using test::add;
using test::black_film;
using test::TemporaryFolder;

namespace {

struct Outcome {
  int status = 0;
  std::string text, error;
};

Outcome run(std::vector<std::string> words) {
  CLI::App app;
  CommandContext context;
  add_compare(app, context);
  add_merge(app, context);
  add_completion(app, context);
  Outcome outcome;
  testing::internal::CaptureStdout();
  try {
    std::reverse(words.begin(), words.end());
    app.parse(words);
    outcome.status = context.exit_status;
  } catch (const CLI::Error &error) {
    outcome.status = 2;
    outcome.error = error.what();
  } catch (const UsageError &error) {
    outcome.status = 2;
    outcome.error = error.what();
  } catch (const Error &error) {
    outcome.status = 1;
    outcome.error = error.what();
  }
  outcome.text = testing::internal::GetCapturedStdout();
  return outcome;
}

// Three films of two samples each; what sample i adds depends on i alone.
Film part(std::uint64_t first) {
  Film film = black_film(6, 4, {{first, first + 2}}, {"alpha"});
  for (std::uint64_t sample = first; sample < first + 2; sample++)
    for (std::size_t pixel = 0; pixel < film.pixels(); pixel++) {
      add(film, sample % 2 ? "beauty.odd" : "beauty.even", pixel, static_cast<int>(sample % 3), 0.25 * static_cast<double>(sample + 1));
      add(film, "alpha", pixel, 0, 0.5);
    }
  return film;
}

struct Films {
  TemporaryFolder folder;
  Films() {
    for (std::uint64_t first = 0; first < 6; first += 2) write_film(path(std::to_string(first) + ".film"), part(first));
  }
  std::string path(const std::string &name) const { return (folder / name).string(); }
};

}  // namespace

TEST(Merge, AnyOrderGivesTheFilmOfOneRender) {
  const Films films;
  Film expected = part(0);
  add_film(expected, part(2));
  add_film(expected, part(4));
  ASSERT_EQ(
      run({"merge", films.path("4.film"), films.path("0.film"), films.path("2.film"), "-o", films.path("a.film"), "-o", films.path("a.exr")}).error,
      "");
  const Outcome json_outcome =
      run({"merge", films.path("2.film"), films.path("4.film"), films.path("0.film"), "--output", films.path("b.film"), "--json"});
  ASSERT_EQ(json_outcome.error, "");
  const json report = json::parse(json_outcome.text);
  EXPECT_EQ(report["film_hash"], film_hash(expected).hex());
  EXPECT_EQ(report["samples"], "0:6");
  EXPECT_EQ(report["samples_per_pixel"], 6);
  EXPECT_EQ(film_hash(read_film(films.path("a.film"))), film_hash(expected));
  EXPECT_EQ(read_file(films.path("a.film")), read_file(films.path("b.film")));
  EXPECT_EQ(std::get<std::vector<float>>(read_picture(films.path("a.exr")).pixels), film_beauty(expected));
  // Step by step as well.
  run({"merge", films.path("4.film"), films.path("2.film"), "-o", films.path("c.film")});
  run({"merge", films.path("c.film"), films.path("0.film"), "-o", films.path("c.film")});
  EXPECT_EQ(film_hash(read_film(films.path("c.film"))), film_hash(expected));
}

TEST(Merge, RefusesAndWritesNothing) {
  const Films films;
  const std::size_t before = films.folder.entries();
  Film other = part(0);  // its samples are there already as well, but that is the lesser reason
  other.settings["max_depth"] = "8";
  write_film(films.path("other.film"), other);
  Outcome outcome = run({"merge", films.path("0.film"), films.path("other.film"), "-o", films.path("out.png")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.error.find("settings differ: max_depth is 16 in " + films.path("0.film") + " and 8 in " + films.path("other.film")),
            std::string::npos)
      << outcome.error;
  outcome = run({"merge", films.path("0.film"), films.path("2.film"), films.path("2.film"), "-o", films.path("out.png")});
  EXPECT_NE(outcome.error.find("samples 2:4 are there already in " + films.path("2.film")), std::string::npos) << outcome.error;
  EXPECT_EQ(run({"merge", films.path("0.film"), "-o", films.path("out.gif")}).status, 2);
  EXPECT_EQ(run({"merge", films.path("0.film"), "-o", films.path("none/out.png")}).status, 1);
  EXPECT_EQ(run({"merge", films.path("none.film"), "-o", films.path("out.png")}).status, 1);
  EXPECT_EQ(run({"merge", films.path("0.film")}).status, 2) << "without -o";
  EXPECT_EQ(run({"merge", "-o", films.path("out.png")}).status, 2) << "without a film";
  EXPECT_EQ(films.folder.entries(), before + 1);
}

TEST(Merge, ViewOptionsReachThePicture) {
  const Films films;
  const std::string film = films.path("0.film");
  const auto bytes = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"merge", film, "-o", films.path("out.png")});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.error, "");
    return std::get<std::vector<std::uint8_t>>(read_image(films.path("out.png")).pixels);
  };
  const auto plain = bytes({});
  EXPECT_EQ(plain.size(), 6u * 4 * 3);
  EXPECT_EQ(bytes({"--exposure", "0"}), plain);
  EXPECT_EQ(bytes({"--exposure", "+0"}), plain);
  EXPECT_NE(bytes({"--exposure", "-1.5"}), plain);
  EXPECT_NE(bytes({"--exposure", "auto"}), plain);
  EXPECT_NE(bytes({"--tone", "filmic"}), plain);
  EXPECT_EQ(bytes({"--transparent"}).size(), 6u * 4 * 4);
  for (const char *bad : {"x", "", "1e", "nan", "inf", "1000", "1,5"})
    EXPECT_EQ(run({"merge", film, "-o", films.path("out.png"), "--exposure", bad}).status, 2) << bad;
  EXPECT_EQ(run({"merge", film, "-o", films.path("out.png"), "--tone", "hable"}).status, 2);
}

TEST(Compare, PrintsAndDecides) {
  const Films films;
  const std::string a = films.path("0.film"), b = films.path("2.film");
  EXPECT_EQ(run({"compare", a, b}).status, 0) << "without a tolerance every answer is a success";
  const Outcome equal = run({"compare", a, a, "--json", "--tolerance", "rmse=0", "--tolerance", "psnr=1000", "--tolerance", "flip=0"});
  EXPECT_EQ(equal.status, 0) << equal.error;
  json report = json::parse(equal.text);
  EXPECT_EQ(report["rmse"], 0.0);
  EXPECT_TRUE(report["psnr"].is_null());
  EXPECT_EQ(report["within_tolerance"], true);

  // Sample 2 adds 0.75 to blue and sample 3 adds 1 to red; samples 0 and 1 add 0.25 to red and 0.5 to green: means differ by 0.375, 0.25 and 0.375.
  const double rmse = std::sqrt((0.375 * 0.375 * 2 + 0.25 * 0.25) / 3);
  Outcome outcome = run({"compare", a, b, "--json", "--tolerance", "rmse=" + std::to_string(rmse - 1e-3)});
  EXPECT_EQ(outcome.status, 1);
  report = json::parse(outcome.text);
  EXPECT_NEAR(report["rmse"].get<double>(), rmse, 1e-6);
  EXPECT_EQ(report["size"], (json{6, 4}));
  EXPECT_EQ(report["beyond"].size(), 1u);
  EXPECT_EQ(report["largest"], 0.375);
  EXPECT_EQ(report["largest_at"], (json{0, 0}));
  EXPECT_EQ(run({"compare", a, b, "--tolerance", "rmse=" + std::to_string(rmse + 1e-3)}).status, 0);
  EXPECT_EQ(run({"compare", a, b, "--tolerance", "psnr=5"}).status, 0);
  outcome = run({"compare", a, b, "--tolerance", "psnr=50", "--tolerance", "rmse=1"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.text.find("beyond tolerance: psnr"), std::string::npos);
}

TEST(Compare, PixelsThatAreNotFiniteAreBeyondAnyTolerance) {
  const Films films;
  const std::string good = films.path("good.exr"), bad = films.path("bad.exr");
  write_picture(good, black_film(1, 1, {{0, 1}}), {});
  // Films hold no NaN, so the picture of another program has it.
  const auto output = OIIO::ImageOutput::create(bad);
  const float pixel[3] = {0, std::numeric_limits<float>::quiet_NaN(), 0};
  ASSERT_TRUE(output && output->open(bad, OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::FLOAT)) && output->write_image(OIIO::TypeDesc::FLOAT, pixel) &&
              output->close());
  Outcome outcome;
  ASSERT_NO_THROW(outcome = run({"compare", bad, good, "--json"}));
  ASSERT_EQ(outcome.error, "");
  EXPECT_EQ(json::parse(outcome.text)["bad_pixels"], 1);
  EXPECT_EQ(run({"compare", bad, good, "--tolerance", "flip=1"}).status, 1);
  EXPECT_EQ(run({"compare", bad, good, "--tolerance", "flip=1", "--tolerance", "bad=1"}).status, 0);
}

TEST(Compare, WrongUsage) {
  const Films films;
  const std::string a = films.path("0.film");
  for (const char *bad : {"rmse", "rmse=", "rmse=x", "rmse=1x", "ssim=1", "=1", "rmse=nan"})
    EXPECT_EQ(run({"compare", a, a, "--tolerance", bad}).status, 2) << bad;
  EXPECT_EQ(run({"compare", a}).status, 2);
  EXPECT_EQ(run({"compare", a, films.path("none.png")}).status, 1);
  write_film(films.path("wide.film"), black_film(7, 4, {{0, 1}}));
  const Outcome outcome = run({"compare", a, films.path("wide.film")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.error.find("has 6x4 pixels, but"), std::string::npos) << outcome.error;
}

}  // namespace sunstone
