// SPDX-License-Identifier: Apache-2.0
// sunstone learn from end to end: every figure in its quick form, what the pages need, and what is asked wrongly.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/process.h"
#include "film/film_file.h"
#include "support/temporary_folder.h"

namespace sunstone::test {
namespace {

const std::string cornell = scene("cornell/cornell.gltf");
const char *const figures[] = {"bounces", "l1-l2", "convergence", "light-sampling", "depth", "branching", "pseudo-code", "strategies", "history", "paths"};

std::string read(const std::filesystem::path &path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Ended learn(const TemporaryFolder &folder, std::vector<std::string> words) {
  words.insert(words.begin(), "learn");
  RunOptions run;
  run.folder = folder / "";
  run.timeout = 400;
  const Ended ended = run_sunstone(words, run);
  EXPECT_EQ(ended.status, 0) << ended.error;
  EXPECT_EQ(ended.error, "");
  return ended;
}

// By columns, as the tests' tables have neither quotes nor line ends in them.
std::vector<std::vector<std::string>> rows_of(const std::filesystem::path &csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(read(csv));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

void expect_refusal(const std::vector<std::string> &words, int status, const std::vector<std::string> &says) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "not a folder";
  RunOptions run;
  run.folder = folder / "";
  const Ended ended = run_sunstone(words, run);
  EXPECT_EQ(ended.status, status) << words.back() << ended.error;
  EXPECT_EQ(lines_of(ended.error, "error").size(), 1u) << ended.error;
  for (const std::string &word : says) EXPECT_NE(ended.error.find(word), std::string::npos) << word << " is not in: " << ended.error;
  EXPECT_EQ(listing(folder / ""), (std::vector<std::string>{"file"})) << words.back();
}

}  // namespace

TEST(Learn, AllFiguresAndTheirIndex) {
  const TemporaryFolder folder;
  const Ended ended = learn(folder, {"all", "--quick", "-o", "a/b"});
  EXPECT_TRUE(plain_text(ended.out)) << ended.out;
  const std::string index = read(folder / "a/b/index.html");
  std::set<std::string> expected = {"index.html"};
  for (const std::string name : figures) {
    EXPECT_NE(ended.out.find("\n" + name + ": "), std::string::npos) << name << "\n" << ended.out;
    EXPECT_NE(index.find("href='" + name + ".html'"), std::string::npos) << name;
    const std::string page = read(folder / "a/b" / (name + ".html"));
    EXPECT_TRUE(page.starts_with("<!DOCTYPE html>")) << name;
    EXPECT_TRUE(page.ends_with("</html>\n")) << name;
    EXPECT_NE(page.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos) << name;
    // Nothing comes from elsewhere: the name of SVG's language is the only address.
    std::string local = page;
    for (std::size_t at; (at = local.find("xmlns='http://www.w3.org/2000/svg'")) != std::string::npos;) local.erase(at, 34);
    for (const char *word : {"http:", "https:", "<script", "<link", "src='/", "url("}) EXPECT_EQ(local.find(word), std::string::npos) << name << " " << word;
    const auto rows = rows_of(folder / "a/b" / (name + ".csv"));
    EXPECT_GE(rows.size(), 3u) << name;
  }
  // Every file is named after its figure: nothing temporary is left.
  for (const std::string &file : listing(folder / "a/b")) {
    bool known = file == "index.html";
    for (const std::string name : figures) known = known || file.starts_with(name);
    EXPECT_TRUE(known && file.find(".part") == std::string::npos && file.find("~") == std::string::npos) << file;
  }
}

// The error of independent samples falls as the square root of their number; 64 samples of 64 pixels show it roughly, a broken measure not at all.
TEST(Learn, ConvergenceHasItsSlope) {
  const TemporaryFolder folder;
  learn(folder, {"convergence", "--quick", "-q", "-o", "out"});
  const auto slopes = rows_of(folder / "out/convergence-slopes.csv");
  ASSERT_EQ(slopes.size(), 3u);
  EXPECT_EQ(slopes[1][0], "independent");
  EXPECT_NEAR(std::stod(slopes[1][1]), -0.5, 0.2);
  const auto rows = rows_of(folder / "out/convergence.csv");
  ASSERT_EQ(rows.size(), 8u);  // 1, 2, 4 ... 64
  EXPECT_EQ(rows[7][0], "64");
  EXPECT_GT(std::stod(rows[1][1]), 3 * std::stod(rows[7][1]));
}

// A student's table: the vertices of a path add up to its contribution, the paths to the pixel of a render of the same samples.
TEST(Learn, PathsAddUpToTheirPixel) {
  const TemporaryFolder folder;
  for (const std::vector<std::string> &flags : std::vector<std::vector<std::string>>{
           {"--integrator", "path"}, {"--integrator", "pure", "--end-on-light"}, {"--integrator", "hybrid", "--light-samples", "3"}, {"--integrator", "path", "--sampler", "independent", "--lanes", "1"}}) {
    std::vector<std::string> words = {"paths", cornell, "--size", "24x18", "--max-depth", "5", "--env", "0.5,0.4,0.3", "--pixel", "13,15", "--sample", "4", "--samples", "12", "--quick", "-q", "-o", "out"};
    words.insert(words.end(), flags.begin(), flags.end());
    learn(folder, words);
    const nlohmann::json j = nlohmann::json::parse(read(folder / "out/paths.json"));
    ASSERT_EQ(j["paths"].size(), 12u);
    std::vector<std::string> render = {"render", cornell, "--size", "24x18", "--max-depth", "5", "--env", "0.5,0.4,0.3", "--samples", "4:16", "--crop", "13,15,14,16", "-q", "-o", "pixel.film"};
    render.insert(render.end(), flags.begin(), flags.end());
    RunOptions run;
    run.folder = folder / "";
    ASSERT_EQ(run_sunstone(render, run).status, 0);
    const std::vector<float> pixel = film_beauty(read_film(folder / "pixel.film"));
    std::size_t lit = 0;
    for (std::size_t c = 0; c < 3; c++) {
      double mean = 0;
      for (const nlohmann::json &path : j["paths"]) {
        double sum = 0;
        for (const nlohmann::json &v : path["vertices"]) sum += v["emission"][c].get<double>() + v["direct"][c].get<double>();
        EXPECT_NEAR(sum, path["contribution"][c].get<double>(), 1e-9);
        mean += sum / 12;
        lit += sum > 0;
      }
      EXPECT_NEAR(mean, pixel[c], 1e-6 + 1e-6 * pixel[c]) << flags[1];
    }
    EXPECT_GT(lit, 0u) << flags[1];
  }
}

// What a vertex says of itself is what a path is: it goes on from where it was, its first throughput is 1, and Lambert's pdf is the cosine over pi.
TEST(Learn, PathsOfAMattRoomFollowLambert) {
  const TemporaryFolder folder;
  learn(folder, {"paths", cornell, "--integrator", "pure", "--size", "24x18", "--filter", "box", "--max-depth", "4", "--pixel", "11,14", "--samples", "32", "--quick", "-q", "-o", "out"});
  const nlohmann::json j = nlohmann::json::parse(read(folder / "out/paths.json"));
  std::size_t turns = 0;
  std::set<std::string> ends;
  for (const nlohmann::json &path : j["paths"]) {
    ends.insert(path["ended"]);
    const nlohmann::json &all = path["vertices"];
    EXPECT_EQ(all[0]["arriving"]["throughput"], (nlohmann::json{1.0, 1.0, 1.0}));
    EXPECT_TRUE(all[0]["arriving"]["delta"]);
    for (std::size_t i = 0; i + 1 < all.size(); i++) {
      const nlohmann::json &v = all[i], &next = all[i + 1];
      EXPECT_EQ(v["leaving"]["as"], "scattered");
      EXPECT_EQ(v["leaving"]["pdf_solid_angle"], next["arriving"]["pdf_solid_angle"]);
      EXPECT_EQ(v["leaving"]["throughput"], next["arriving"]["throughput"]);
      EXPECT_EQ(next["depth"], v["depth"].get<int>() + 1);
      double direction[3], length = 0, cosine = 0;
      if (next["type"] == "escaped") continue;
      for (std::size_t c = 0; c < 3; c++) {
        direction[c] = next["position"][c].get<double>() - v["position"][c].get<double>();
        length += direction[c] * direction[c];
        cosine += direction[c] * v["normal"][c].get<double>();
      }
      cosine /= std::sqrt(length);
      EXPECT_NEAR(v["leaving"]["pdf_solid_angle"].get<double>(), cosine / M_PI, 2e-3) << "sample " << path["sample"] << " vertex " << i;
      turns++;
    }
    EXPECT_EQ(all.back()["leaving"]["as"], "ended");
    EXPECT_EQ(all.back()["type"] == "escaped", path["ended"] == "escaped");
  }
  EXPECT_GT(turns, 30u);
  EXPECT_GE(ends.size(), 2u);
}

TEST(Learn, WhatIsAskedWrongly) {
  expect_refusal({"learn"}, 2, {"convergence", "pseudo-code", "all"});
  expect_refusal({"learn", "everything"}, 2, {"everything", "convergence", "paths", "all"});
  expect_refusal({"learn", "bounces", "depth"}, 2, {"depth"});
  expect_refusal({"learn", "bounces", "--spp", "4"}, 2, {"--spp"});
  expect_refusal({"learn", "bounces", "--quick", "-o", "file"}, 1, {"file"});
  expect_refusal({"learn", "bounces", "--quick", "-o", "file/below"}, 1, {"file/below"});
  expect_refusal({"learn", "bounces", "--device", "no such device", "-o", "."}, 2, {"no such device"});
  expect_refusal({"learn", "paths"}, 2, {"scene"});
  expect_refusal({"learn", "paths", cornell}, 2, {"--pixel"});
  for (const char *pixel : {"8,0", "0,8", "-1,0", "1", "1,2,3", "1.5,2", "nan,0", "a,b"}) expect_refusal({"learn", "paths", cornell, "--size", "8x8", "--pixel", pixel}, 2, {"--pixel"});
  expect_refusal({"learn", "paths", cornell, "--pixel", "1,1", "--samples", "0"}, 2, {"--samples"});
  expect_refusal({"learn", "paths", cornell, "--pixel", "1,1", "--samples", "257"}, 2, {"--samples"});
  expect_refusal({"learn", "paths", cornell, "--pixel", "1,1", "--sample", "4294967290"}, 2, {"--sample"});
  for (const char *other : {"distribution", "bdpt", "photon", "sppm", "vcm", "whitted"}) expect_refusal({"learn", "paths", cornell, "--pixel", "1,1", "--integrator", other}, 2, {other, "hybrid"});
  expect_refusal({"learn", "paths", "no-such.gltf", "--pixel", "1,1", "-o", "."}, 1, {"no-such.gltf"});
}

TEST(Learn, HelpNamesTheFigures) {
  const Ended ended = run_sunstone({"learn", "--help"});
  EXPECT_EQ(ended.status, 0);
  for (const std::string name : figures) EXPECT_NE(ended.out.find("\n  " + name), std::string::npos) << name << "\n" << ended.out;
  const Ended paths = run_sunstone({"learn", "paths", "--help"});
  EXPECT_EQ(paths.status, 0);
  for (const char *flag : {"--pixel", "--sample ", "--samples", "--integrator", "Examples"}) EXPECT_NE(paths.out.find(flag), std::string::npos) << flag;
  for (const char *flag : {"--checkpoint", "--spp"}) EXPECT_EQ(paths.out.find(flag), std::string::npos) << flag;
}

}  // namespace sunstone::test
