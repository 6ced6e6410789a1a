// SPDX-License-Identifier: Apache-2.0
// sunstone render from end to end: pictures, films, ranges of samples, checkpoints, statistics, what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/file.h"
#include "cli/process.h"
#include "film/film_file.h"
#include "support/temporary_folder.h"
#include "image/image.h"

namespace sunstone::test {
namespace {

const std::string cornell = scene("cornell/cornell.gltf");

// In `folder`, at a small size; it has to end well, without warnings.
Ended render(const TemporaryFolder &folder, std::vector<std::string> words) {
  words.insert(words.begin(), {"render", cornell, "--size", "32x24", "--max-depth", "4"});
  RunOptions run;
  run.folder = folder / "";
  const Ended ended = run_sunstone(words, run);
  EXPECT_EQ(ended.status, 0) << ended.error;
  EXPECT_EQ(ended.error, "");
  return ended;
}

std::string hash_of(const TemporaryFolder &folder, const std::string &name) { return film_hash(read_film(folder / name)).hex(); }

nlohmann::json read_json(const std::filesystem::path &path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in);
}

}  // namespace

TEST(Render, WritesEveryOutputAndNothingElse) {
  const TemporaryFolder folder;
  const Ended ended = render(folder, {"--spp", "2", "-o", "a.png", "-o", "b.exr", "-o", "c.film", "-o", "d.hdr", "-o", "e.jpg", "-o", "f.tif"});
  EXPECT_EQ(listing(folder / ""), (std::vector<std::string>{"a.png", "b.exr", "c.film", "d.hdr", "e.jpg", "f.tif"}));
  for (const char *name : {"a.png", "b.exr", "d.hdr", "e.jpg"}) {
    const Image image = read_image(folder / name);
    EXPECT_EQ(image.width, 32) << name;
    EXPECT_EQ(image.height, 24) << name;
    EXPECT_NE(ended.out.find(name), std::string::npos) << "it says where the files are";
  }
  const Film film = read_film(folder / "c.film");
  EXPECT_NE(ended.out.find(film_hash(film).hex()), std::string::npos);
  const Image image = read_image(folder / "b.exr");
  const std::vector<float> beauty = film_beauty(film), &values = std::get<std::vector<float>>(image.pixels);
  for (std::size_t i = 0; i < film.pixels(); i++)
    for (std::size_t c = 0; c < 3; c++) ASSERT_EQ(values[i * static_cast<std::size_t>(image.channels) + c], beauty[i * 3 + c]);
}

// A file without light and camera: what was done about it is said, but for -q, and for a camera that is given anyway.
TEST(Render, NotesAreSaidUnlessQuiet) {
  const TemporaryFolder folder;
  RunOptions run;
  run.folder = folder / "";
  const std::string bare = folder / "bare.obj";
  std::ofstream(bare) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
  const auto notes = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", bare, "--size", "8x8", "--spp", "1", "--max-depth", "1", "-o", "a.png"});
    const Ended ended = run_sunstone(words, run);
    EXPECT_EQ(ended.status, 0) << ended.error;
    return lines_of(ended.error, "note");
  };
  EXPECT_EQ(notes({}).size(), 2u);
  EXPECT_EQ(notes({"--look-from", "1,2,3", "--look-at", "0,0,0"}).size(), 1u) << "of the light alone";
  EXPECT_EQ(notes({"-q"}).size(), 0u);
}

// An integrator that leaves light out says so once, with the names of those that follow it; where nothing is left out nothing is said.
TEST(Render, LightThatIsLeftOutIsNamed) {
  const TemporaryFolder folder;
  RunOptions run;
  run.folder = folder / "";
  const auto notes = [&](const std::string &file, const std::string &integrator) {
    const Ended ended = run_sunstone({"render", file, "--integrator", integrator, "--size", "8x8", "--spp", "1", "--max-depth", "2", "-o", "a.png"}, run);
    EXPECT_EQ(ended.status, 0) << ended.error;
    return lines_of(ended.error, "note");
  };
  const std::string glass_and_point = scene("whitted/whitted.gltf");
  for (const auto &[file, integrator, follows] : {std::tuple<std::string, const char *, const char *>{cornell, "whitted", "path"}, {cornell, "distribution", "path"}, {glass_and_point, "path", "sppm"},
                                                  {glass_and_point, "hybrid", "vcm"}}) {
    const std::vector<std::string> said = notes(file, integrator);
    ASSERT_EQ(said.size(), 1u) << integrator;
    EXPECT_NE(said[0].find(std::string("--integrator ") + integrator), std::string::npos) << said[0];
    EXPECT_NE(said[0].find(follows), std::string::npos) << said[0];
  }
  for (const char *integrator : {"path", "hybrid", "pure"}) EXPECT_TRUE(notes(cornell, integrator).empty()) << integrator;
  EXPECT_TRUE(notes(glass_and_point, "sppm").empty());
}

TEST(Render, WithoutOutputTheScenesStem) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "1"});
  EXPECT_EQ(listing(folder / ""), (std::vector<std::string>{"cornell.png"}));
}

TEST(Render, RangesOfSamplesMergeToOneRun) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "6", "-o", "whole.film", "--aov", "all"});
  render(folder, {"--samples", "4:6", "-o", "c.film", "--aov", "all", "--pool", "64"});
  render(folder, {"--samples", "0:1", "-o", "a.film", "--aov", "all", "--layout", "binary"});
  render(folder, {"--samples", "1:4", "-o", "b.film", "--aov", "all", "--lanes", "8"});
  RunOptions run;
  run.folder = folder / "";
  const Ended merged = run_sunstone({"merge", "c.film", "a.film", "b.film", "-o", "merged.film"}, run);
  ASSERT_EQ(merged.status, 0) << merged.error;
  EXPECT_EQ(hash_of(folder, "merged.film"), hash_of(folder, "whole.film"));
  const Film whole = read_film(folder / "whole.film"), sum = read_film(folder / "merged.film");
  ASSERT_EQ(whole.layers.size(), sum.layers.size());
  for (std::size_t i = 0; i < whole.layers.size(); i++) EXPECT_EQ(whole.layers[i].values, sum.layers[i].values) << whole.layers[i].name;
  EXPECT_EQ(whole.samples, sum.samples);
}

namespace {

// A triangle before a camera, which goes to the right by 1 a second, for two seconds; alone in the light of --env.
void write_moving_triangle(const std::filesystem::path &path) {
  std::ofstream(path) << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 1, "output": 2}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}, {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                  {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}, {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
    "buffers": [{"byteLength": 68, "uri": "motion.bin"}]})";
  const float numbers[17] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 2, 0, 0, 0, 2, 0, 0};
  std::ofstream(path.parent_path() / "motion.bin", std::ios::binary).write(reinterpret_cast<const char *>(numbers), sizeof numbers);
}

}  // namespace

// A frame is the picture of its time, whichever range it is rendered in; the view, made up from the scene at rest, stands still.
TEST(Render, FramesAreThePicturesOfTheirTimes) {
  const TemporaryFolder folder;
  write_moving_triangle(folder / "move.gltf");
  const std::vector<std::string> before = listing(folder / "");
  const auto go = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", "move.gltf", "--size", "24x16", "--max-depth", "1", "--env", "1,1,1", "-q"});
    if (std::ranges::find(words, "--samples") == words.end()) words.insert(words.end(), {"--spp", "4"});
    RunOptions run;
    run.folder = folder / "";
    const Ended ended = run_sunstone(words, run);
    EXPECT_EQ(ended.status, 0) << ended.error;
    return ended;
  };
  go({"--frames", "9:12", "--fps", "10", "-o", "all.film", "-o", "all.png", "--stats", "s.json"});
  std::vector<std::string> after = before;
  for (const char *name : {"all.0009.film", "all.0010.film", "all.0011.film", "all.0009.png", "all.0010.png", "all.0011.png", "s.0009.json", "s.0010.json", "s.0011.json"})
    after.emplace_back(name);
  std::sort(after.begin(), after.end());
  EXPECT_EQ(listing(folder / ""), after);
  go({"--frames", "11:12", "--fps", "10", "-o", "alone.film"});
  go({"--time-at", "1", "-o", "at-1.film"});
  go({"--time-at", "1", "--frames", "0:1", "-o", "from-1.film"});
  go({"-o", "rest.film"});
  EXPECT_EQ(hash_of(folder, "all.0011.film"), hash_of(folder, "alone.0011.film"));
  EXPECT_EQ(hash_of(folder, "all.0010.film"), hash_of(folder, "at-1.film"));
  EXPECT_EQ(hash_of(folder, "from-1.0000.film"), hash_of(folder, "at-1.film"));
  EXPECT_NE(hash_of(folder, "all.0009.film"), hash_of(folder, "all.0010.film"));
  EXPECT_NE(hash_of(folder, "rest.film"), hash_of(folder, "at-1.film"));
  EXPECT_EQ(read_json(folder / "s.0010.json").at("film_hash"), hash_of(folder, "all.0010.film"));

  const Film rest = read_film(folder / "rest.film"), later = read_film(folder / "at-1.film");
  EXPECT_EQ(rest.settings.at("camera"), later.settings.at("camera")) << "the view stands still";
  EXPECT_FALSE(rest.settings.contains("time-at"));
  EXPECT_EQ(later.settings.at("time-at"), "1");
  EXPECT_NE(rest.scene_hash, later.scene_hash);
  RunOptions run;
  run.folder = folder / "";
  const auto merge = [&](const char *a, const char *b) {
    const Ended merged = run_sunstone({"merge", a, b, "-o", "sum.film"}, run);
    EXPECT_EQ(merged.status, 1);
    return merged.error;
  };
  EXPECT_NE(merge("all.0009.film", "all.0010.film").find("scenes differ"), std::string::npos);
  // Beyond its end all is the same, but for what was asked for.
  go({"--frames", "3:5", "--fps", "1", "--samples", "0:4", "-o", "end.film"});
  EXPECT_EQ(read_film(folder / "end.0003.film").scene_hash, read_film(folder / "end.0004.film").scene_hash);
  EXPECT_NE(merge("end.0003.film", "end.0004.film").find("time-at is 3"), std::string::npos);
  // A shutter that is closed, or open while all keeps still, changes no bit; over motion it does, in frames as in a picture of the same time.
  go({"--time-at", "1", "--shutter", "0", "-o", "closed.film"});
  go({"--time-at", "1", "--shutter", "0.5", "-o", "open.film"});
  go({"--frames", "10:11", "--fps", "10", "--shutter", "0.5", "-o", "blurred.film"});
  go({"--time-at", "3", "--shutter", "0.5", "-o", "still.film"});
  EXPECT_EQ(hash_of(folder, "closed.film"), hash_of(folder, "at-1.film"));
  EXPECT_EQ(hash_of(folder, "still.film"), hash_of(folder, "end.0003.film"));
  EXPECT_NE(hash_of(folder, "open.film"), hash_of(folder, "at-1.film"));
  EXPECT_EQ(hash_of(folder, "blurred.0010.film"), hash_of(folder, "open.film"));
  EXPECT_EQ(read_film(folder / "open.film").settings.at("shutter"), "0.5");
  EXPECT_EQ(read_film(folder / "still.film").scene_hash, read_film(folder / "end.0003.film").scene_hash);
  EXPECT_NE(merge("still.film", "end.0003.film").find("shutter"), std::string::npos);
}

TEST(Render, CheckpointAndResumeEqualOneRun) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "7", "-o", "whole.film"});
  render(folder, {"--spp", "3", "--checkpoint", "part.film", "-o", "part.png"});
  EXPECT_NE(hash_of(folder, "part.film"), hash_of(folder, "whole.film"));
  render(folder, {"--spp", "7", "--resume", "part.film", "-o", "resumed.film", "--stats", "stats.json"});
  EXPECT_EQ(read_json(folder / "stats.json")["film_hash"], hash_of(folder, "resumed.film")) << "of what was written, not of what was added";
  EXPECT_EQ(read_json(folder / "stats.json")["samples_per_pixel"], 7);
  EXPECT_EQ(hash_of(folder, "resumed.film"), hash_of(folder, "whole.film"));
  EXPECT_EQ(read_film(folder / "resumed.film").samples, read_film(folder / "whole.film").samples);
  // Once more: there is nothing left to do, and the picture is the same.
  render(folder, {"--spp", "7", "--resume", "resumed.film", "-o", "again.film"});
  EXPECT_EQ(hash_of(folder, "again.film"), hash_of(folder, "whole.film"));
  // Checkpoint and resume of one and the same file, as a job that is started again and again.
  render(folder, {"--spp", "7", "--resume", "part.film", "--checkpoint", "part.film"});
  EXPECT_EQ(hash_of(folder, "part.film"), hash_of(folder, "whole.film"));
}

TEST(Render, AFilmOfAnotherPictureIsNotResumed) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "2", "-o", "a.film"});
  for (const std::vector<std::string> &change : std::vector<std::vector<std::string>>{{"--seed", "1"}, {"--max-depth", "3"}, {"--size", "32x25"}, {"--filter", "box"}, {"--env", "1,1,1"}}) {
    std::vector<std::string> words{"render", cornell, "--size", "32x24", "--max-depth", "4", "--spp", "4", "--resume", "a.film", "-o", "b.png"};
    for (std::size_t i = 0; i < words.size(); i++)
      if (words[i] == change[0]) words[i + 1] = change[1];
    if (std::find(words.begin(), words.end(), change[0]) == words.end()) words.insert(words.end(), change.begin(), change.end());
    RunOptions run;
    run.folder = folder / "";
    const Ended ended = run_sunstone(words, run);
    EXPECT_EQ(ended.status, 1) << change[0];
    EXPECT_EQ(lines_of(ended.error, "error").size(), 1u) << ended.error;
    EXPECT_EQ(listing(folder / ""), (std::vector<std::string>{"a.film"})) << change[0];
  }
}

TEST(Render, StatisticsHaveEveryKey) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "4", "-o", "a.film", "--aov", "all", "--stats", "stats.json"});
  const nlohmann::json j = read_json(folder / "stats.json");
  for (const char *key : {"samples_per_pixel", "render_seconds", "startup_seconds", "samples_per_s", "rays_per_s", "stages", "live_paths_by_bounce", "ended", "build_seconds", "compile_seconds",
                          "upload_seconds", "memory", "clamped", "nan", "scene_hash", "film_hash", "layer_hashes", "device", "reproducible"})
    EXPECT_TRUE(j.contains(key)) << key;
  const Film film = read_film(folder / "a.film");
  EXPECT_EQ(j["film_hash"], film_hash(film).hex());
  EXPECT_EQ(j["scene_hash"], film.scene_hash);
  EXPECT_EQ(j["layer_hashes"].size(), film.layers.size());
  for (const FilmLayer &layer : film.layers) EXPECT_EQ(j["layer_hashes"][layer.name], layer_hash(film, layer).hex()) << layer.name;
  EXPECT_EQ(j["samples_per_pixel"], 4);
  EXPECT_EQ(j["nan"], 0);
  EXPECT_EQ(j["clamped"], 0);
  EXPECT_EQ(j["interrupted"], false);
  for (const char *kind : {"camera", "bounce", "shadow"}) EXPECT_GT(j["rays_per_s"][kind].get<double>(), 0) << kind;
  std::uint64_t ended = 0;
  for (const char *reason : {"light", "depth", "escaped", "absorbed"}) ended += j["ended"][reason].get<std::uint64_t>();
  EXPECT_EQ(ended, 32u * 24 * 4);
  EXPECT_EQ(j["live_paths_by_bounce"][0], 32 * 24 * 4);
  for (std::size_t i = 1; i < j["live_paths_by_bounce"].size(); i++) EXPECT_LE(j["live_paths_by_bounce"][i].get<std::uint64_t>(), j["live_paths_by_bounce"][i - 1].get<std::uint64_t>());
  EXPECT_LE(j["live_paths_by_bounce"].size(), 5u);
  double busy = 0;
  for (const nlohmann::json &stage : j["stages"]) {
    for (const char *key : {"stage", "launches", "items", "seconds"}) EXPECT_TRUE(stage.contains(key)) << key;
    busy += stage["seconds"].get<double>();
  }
  EXPECT_GT(busy, 0);
  EXPECT_LE(busy, j["render_seconds"].get<double>() + j["upload_seconds"].get<double>() + j["startup_seconds"].get<double>() + 0.5);
  EXPECT_GT(j["startup_seconds"].get<double>(), 0);
}

TEST(Render, TuningAndDeviceFlagsNeverChangeABit) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "2", "-o", "reference.film"});
  const std::string reference = hash_of(folder, "reference.film");
  for (const std::vector<std::string> &flags : std::vector<std::vector<std::string>>{{"--pool", "100"}, {"--layout", "binary"}, {"--layout", "wide8"}, {"--lanes", "8"}, {"--threads", "1"}, {"--update", "0.1"}}) {
    std::vector<std::string> words{"--spp", "2", "-o", "other.film"};
    words.insert(words.end(), flags.begin(), flags.end());
    render(folder, words);
    EXPECT_EQ(hash_of(folder, "other.film"), reference) << flags[0] << " " << flags[1];
  }
  render(folder, {"--spp", "2", "--seed", "1", "-o", "other.film"});
  EXPECT_NE(hash_of(folder, "other.film"), reference);
}

TEST(Render, SaysWhatItDoesInPlainLines) {
  const TemporaryFolder folder;
  const Ended loud = render(folder, {"--spp", "16", "-o", "a.png"});
  EXPECT_TRUE(plain_text(loud.out)) << loud.out;
  for (const char *word : {"triangles", "samples per pixel", "a.png"}) EXPECT_NE(loud.out.find(word), std::string::npos) << word << "\n" << loud.out;
  const Ended quiet = render(folder, {"--spp", "1", "-o", "a.png", "-q"});
  EXPECT_EQ(quiet.out, "");
}

TEST(Render, TimeEndsARender) {
  const TemporaryFolder folder;
  const Ended ended = render(folder, {"--time", "0.5", "-o", "a.film", "--stats", "stats.json"});
  EXPECT_LT(ended.seconds, 60);
  const nlohmann::json j = read_json(folder / "stats.json");
  EXPECT_GE(j["samples_per_pixel"].get<std::uint64_t>(), 1u);
  EXPECT_GE(j["render_seconds"].get<double>(), 0.5);
  EXPECT_LT(j["render_seconds"].get<double>(), 30);
}

TEST(Render, ErrorEndsARender) {
  const TemporaryFolder folder;
  render(folder, {"--error", "0.5", "-o", "a.film"});
  const Film film = read_film(folder / "a.film");
  EXPECT_LE(estimated_error(film), 0.5);
  EXPECT_LT(film.sample_count(), 100000u);
}

TEST(Render, CropsAndTransparentBackgrounds) {
  const TemporaryFolder folder;
  render(folder, {"--spp", "1", "--crop", "4,5,14,12", "-o", "a.film"});
  const Film film = read_film(folder / "a.film");
  EXPECT_EQ(film.width(), 10);
  EXPECT_EQ(film.height(), 7);
  EXPECT_EQ(film.picture_width, 32);
  render(folder, {"--spp", "1", "--background", "transparent", "-o", "a.png"});
  EXPECT_EQ(read_image(folder / "a.png").channels, 4);
}

// The hashes that the program ships with are those that it gives: a change of the renderer that changes pictures changes them on purpose.
TEST(Verify, ThisDeviceGivesTheBitsThatShip) {
  const Ended ended = run_sunstone({"verify", "--json"});
  EXPECT_EQ(ended.status, 0) << ended.out << ended.error;
  const nlohmann::json j = nlohmann::json::parse(ended.out);
  EXPECT_FALSE(j.empty());
}

}  // namespace sunstone::test
