// SPDX-License-Identifier: Apache-2.0
// Ctrl-C keeps what is there and ends well; twice ends at once. A checkpoint that was cut short is gone on with, bit for bit.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/process.h"
#include "film/film_file.h"
#include "support/temporary_folder.h"

namespace sunstone::test {
namespace {

const std::string cornell = scene("cornell/cornell.gltf");

// Sends `signals`, a little apart, once samples are being rendered: the scene's line and then a line of progress, or two seconds, have passed.
std::function<void(pid_t, const std::string &)> interrupt(std::vector<int> signals) {
  return [signals, sent = false, loaded = std::chrono::steady_clock::time_point()](pid_t process, const std::string &out) mutable {
    if (sent || out.find("triangles") == std::string::npos) return;
    const auto now = std::chrono::steady_clock::now();
    if (loaded == std::chrono::steady_clock::time_point()) loaded = now;
    if (now - loaded < std::chrono::seconds(3) && out.find("samples/s") == std::string::npos) return;
    for (const int signal : signals) {
      kill(process, signal);
      usleep(20000);
    }
    sent = true;
  };
}

}  // namespace

TEST(Interrupt, OnceKeepsThePictureAndEndsWell) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    RunOptions run;
    run.folder = folder / "";
    run.meanwhile = interrupt({signal});
    const Ended ended = run_sunstone({"render", cornell, "--size", "64x48", "--spp", "1000000", "-o", "a.png", "-o", "a.film", "--stats", "stats.json"}, run);
    ASSERT_FALSE(ended.timed_out) << ended.out;
    EXPECT_EQ(ended.status, 0) << ended.error;
    EXPECT_EQ(ended.error, "");
    EXPECT_NE(ended.out.find("interrupted"), std::string::npos) << "it says so, and how much there is: " << ended.out;
    EXPECT_EQ(listing(folder / ""), (std::vector<std::string>{"a.film", "a.png", "stats.json"}));
    const Film film = read_film(folder / "a.film");
    EXPECT_TRUE(film.interrupted);
    EXPECT_GE(film.sample_count(), 1u);
    EXPECT_LT(film.sample_count(), 1000000u);
    std::ifstream in(folder / "stats.json");
    const nlohmann::json j = nlohmann::json::parse(in);
    EXPECT_EQ(j["interrupted"], true);
    EXPECT_EQ(j["samples_per_pixel"], film.sample_count());
  }
}

TEST(Interrupt, TwiceEndsAtOnceWithoutAPicture) {
  const TemporaryFolder folder;
  RunOptions run;
  run.folder = folder / "";
  run.meanwhile = interrupt({SIGINT, SIGINT});
  // Large: the samples that have begun take longer than it is from one signal to the other.
  const Ended ended = run_sunstone({"render", cornell, "--size", "2048x2048", "--spp", "100000", "-o", "a.png"}, run);
  ASSERT_FALSE(ended.timed_out) << ended.out;
  EXPECT_EQ(ended.status, 130) << ended.error;
  EXPECT_EQ(listing(folder / ""), std::vector<std::string>{}) << "nothing half-written";
}

TEST(Interrupt, WhatWasKeptIsGoneOnWith) {
  const TemporaryFolder folder;
  RunOptions run;
  run.folder = folder / "";
  const auto words = [](std::vector<std::string> more) {
    std::vector<std::string> all{"render", cornell, "--size", "16x16", "--max-depth", "4", "--samples"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  run.meanwhile = interrupt({SIGINT});
  Ended ended = run_sunstone(words({"0:10000000", "--checkpoint", "kept.film"}), run);
  ASSERT_EQ(ended.status, 0) << ended.error;
  const std::uint64_t done = read_film(folder / "kept.film").sample_count();
  ASSERT_LT(done, 10000000u);
  run.meanwhile = {};
  const std::string more = "0:" + std::to_string(done + 5);
  ended = run_sunstone(words({more, "--resume", "kept.film", "-o", "resumed.film"}), run);
  ASSERT_EQ(ended.status, 0) << ended.error;
  ended = run_sunstone(words({more, "-o", "whole.film"}), run);
  ASSERT_EQ(ended.status, 0) << ended.error;
  EXPECT_EQ(film_hash(read_film(folder / "resumed.film")), film_hash(read_film(folder / "whole.film")));
  EXPECT_FALSE(read_film(folder / "resumed.film").interrupted) << "it is whole now";
}

}  // namespace sunstone::test
