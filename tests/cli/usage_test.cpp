// SPDX-License-Identifier: Apache-2.0
// What is asked wrongly ends with status 2, what cannot be done with 1; one line says why, and nothing is left behind.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/process.h"
#include "support/temporary_folder.h"

namespace sunstone::test {
namespace {

const std::string cornell = scene("cornell/cornell.gltf");

void expect_refusal(const std::vector<std::string> &words, int status, const std::string &says) {
  const TemporaryFolder folder;
  std::ofstream(folder / "empty.glb").flush();
  std::ofstream(folder / "empty.gltf").flush();
  std::ofstream(folder / "empty.obj").flush();
  std::ofstream(folder / "no.film") << "SUNFILM1, but that is all";
  std::filesystem::create_directory(folder / "folder.png");
  const std::vector<std::string> before = listing(folder / "");
  RunOptions run;
  run.folder = folder / "";
  const Ended ended = run_sunstone(words, run);
  std::string what = "sunstone";
  for (const std::string &word : words) what += " " + word;
  EXPECT_EQ(ended.status, status) << what << "\n" << ended.error;
  EXPECT_FALSE(ended.timed_out) << what;
  EXPECT_EQ(lines_of(ended.error, "error").size(), 1u) << what << "\n" << ended.error;
  EXPECT_TRUE(ended.error.ends_with("\n")) << what;
  EXPECT_NE(ended.error.find(says), std::string::npos) << what << ": '" << says << "' is not in: " << ended.error;
  // Notes and warnings may stand before it; every line says which it is.
  std::size_t lines = 0;
  for (const char c : ended.error) lines += c == '\n';
  EXPECT_EQ(lines, lines_of(ended.error, "error").size() + lines_of(ended.error, "warning").size() + lines_of(ended.error, "note").size()) << what << "\n" << ended.error;
  EXPECT_TRUE(plain_text(ended.error)) << what;
  EXPECT_EQ(listing(folder / ""), before) << what << " left something behind";
}

}  // namespace

TEST(Usage, ScenesThatCannotBeRead) {
  expect_refusal({"render", "no-such-scene.gltf"}, 1, "no-such-scene.gltf");
  expect_refusal({"render", "empty.glb"}, 1, "empty");
  expect_refusal({"render", "empty.gltf"}, 1, "empty.gltf");
  expect_refusal({"render", "empty.obj"}, 1, "empty.obj");
  expect_refusal({"render", "folder.png"}, 1, "folder.png");
  expect_refusal({"render", "."}, 1, ".");
  expect_refusal({"render", cornell, "--env", "no-such-sky.hdr"}, 1, "no-such-sky.hdr");
  expect_refusal({"render"}, 2, "scene");
}

TEST(Usage, Sizes) {
  for (const char *size : {"0x0", "0x10", "10x0", "-5x5", "10", "10x", "x10", "10x10x10", "1e3x5", "70000x10", "65536x65536", "99999999999x1", " 5x5", ""})
    expect_refusal({"render", cornell, "--size", size}, 2, "--size");
  for (const char *crop : {"0,0,0,0", "1,2,3", "0,0,9,7", "-1,0,4,4", "3,3,2,4", "a,b,c,d"})
    expect_refusal({"render", cornell, "--size", "8x8", "--crop", crop}, 2, "--crop");
}

TEST(Usage, Samples) {
  for (const char *spp : {"0", "-1", "1.5", "many", "4294967297", "99999999999999999999"}) expect_refusal({"render", cornell, "--spp", spp}, 2, "--spp");
  for (const char *samples : {"", "4", "4:4", "5:4", ":4", "4:", "-1:4", "0:4294967297", "a:b", "0:1:2", "0:1 "}) {
    if (*samples) expect_refusal({"render", cornell, "--samples", samples}, 2, "--samples");
  }
  expect_refusal({"render", cornell, "--samples", "0:4", "--spp", "4"}, 2, "--samples");
  expect_refusal({"render", cornell, "--max-depth", "-1"}, 2, "--max-depth");
  expect_refusal({"render", cornell, "--max-depth", "5000"}, 2, "--max-depth");
  expect_refusal({"render", cornell, "--seed", "4294967296"}, 2, "--seed");
}

TEST(Usage, NamesThatAreNotKnown) {
  expect_refusal({"render", cornell, "--colour"}, 2, "--colour");
  expect_refusal({"render", cornell, "--device", "no such device"}, 2, "no such device");
  expect_refusal({"render", cornell, "--integrator", "radiosity"}, 2, "radiosity");
  expect_refusal({"render", cornell, "--filter", "sinc"}, 2, "sinc");
  expect_refusal({"render", cornell, "--sampler", "halton"}, 2, "--sampler");
  expect_refusal({"render", cornell, "--layout", "octree"}, 2, "octree");
  expect_refusal({"render", cornell, "--lanes", "7"}, 2, "--lanes");
  expect_refusal({"render", cornell, "--aov", "beauty,velocity"}, 2, "velocity");
  expect_refusal({"render", cornell, "--camera", "no such camera"}, 2, "no such camera");
  expect_refusal({"render", cornell, "--camera", "7"}, 2, "7");
  expect_refusal({"render", cornell, "--look-from", "1,2,3"}, 2, "--look-at");
  expect_refusal({"render", cornell, "--look-from", "1,2,3", "--look-at", "1,2,3"}, 2, "--look-");
  expect_refusal({"render", cornell, "--look-from", "1,2", "--look-at", "1,2,3"}, 2, "--look-from");
  expect_refusal({"render", cornell, "--look-from", "nan,2,1", "--look-at", "1,2,3"}, 2, "--look-from");
  expect_refusal({"render", cornell, "--fov", "0"}, 2, "--fov");
  expect_refusal({"paint"}, 2, "");
  expect_refusal({}, 2, "");
}

// Flags of single integrators: elsewhere they are refused by the name of the one that takes them, and so are values that mean nothing.
TEST(Usage, FlagsOfOneIntegrator) {
  expect_refusal({"render", cornell, "--end-on-light"}, 2, "--end-on-light");
  expect_refusal({"render", cornell, "--sampling", "cosine"}, 2, "--integrator path");
  expect_refusal({"render", cornell, "--integrator", "pure", "--light-samples", "2"}, 2, "--integrator pure");
  expect_refusal({"render", cornell, "--integrator", "pure", "--sampling", "even"}, 2, "even");
  expect_refusal({"render", cornell, "--integrator", "hybrid", "--light-samples", "0"}, 2, "pure");
  expect_refusal({"render", cornell, "--integrator", "hybrid", "--light-samples", "-3"}, 2, "pure");
  expect_refusal({"render", cornell, "--integrator", "hybrid", "--light-samples", "65"}, 2, "65");
  expect_refusal({"render", cornell, "--integrator", "path", "--indirect-samples", "2"}, 2, "--integrator hybrid");
  expect_refusal({"render", cornell, "--integrator", "hybrid", "--indirect-samples", "0"}, 2, "1 to 1024");
  expect_refusal({"render", cornell, "--integrator", "hybrid", "--indirect-samples", "64"}, 2, "--max-depth 3 or less");
  expect_refusal({"render", cornell, "--strategy", "1,2"}, 2, "--integrator bdpt");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--strategy", "2,0"}, 2, "at least 1");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--strategy", "1"}, 2, "S,T");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--strategy", "1,1"}, 2, "0,2");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--unweighted"}, 2, "--strategy");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--heuristic", "maximum"}, 2, "maximum");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--crop", "0,0,8,8"}, 2, "--crop");
  expect_refusal({"render", cornell, "--integrator", "bdpt", "--max-depth", "100"}, 2, "64");
  expect_refusal({"render", cornell, "--radius", "0.1"}, 2, "--integrator photon or --integrator sppm");
  expect_refusal({"render", cornell, "--integrator", "sppm", "--caustic-radius", "0.1"}, 2, "--integrator photon");
  expect_refusal({"render", cornell, "--integrator", "photon", "--alpha", "0.5"}, 2, "--integrator sppm");
  for (const char *radius : {"0", "-1", "nan", "inf", "1e-9", "1e9"}) expect_refusal({"render", cornell, "--integrator", "sppm", "--radius", radius}, 2, "--radius");
  expect_refusal({"render", cornell, "--integrator", "photon", "--caustic-radius", "0"}, 2, "--caustic-radius");
  for (const char *alpha : {"0", "1.5", "nan", "-1"}) expect_refusal({"render", cornell, "--integrator", "sppm", "--alpha", alpha}, 2, "--alpha");
  for (const char *photons : {"0", "-5", "268435457"}) expect_refusal({"render", cornell, "--integrator", "photon", "--photons", photons}, 2, "--photons");
  expect_refusal({"render", cornell, "--integrator", "sppm", "--max-depth", "65"}, 2, "64");
  expect_refusal({"render", cornell, "--integrator", "hybrid", "--nee", "last"}, 2, "last");
  expect_refusal({"render", cornell, "--integrator", "path", "--ambient", "1,1,1"}, 2, "--integrator whitted");
  expect_refusal({"render", cornell, "--integrator", "whitted", "--ambient", "1,1"}, 2, "3 numbers");
  expect_refusal({"render", cornell, "--integrator", "whitted", "--ambient", "1,-1,1"}, 2, "from 0");
  expect_refusal({"render", cornell, "--integrator", "whitted", "--cutoff", "2"}, 2, "--cutoff");
  for (const char *chance : {"1", "-0.1", "nan", "0.99999999999"})
    expect_refusal({"render", cornell, "--integrator", "hybrid", "--absorption", chance}, 2, "--absorption");
}

TEST(Usage, TimesAndFrames) {
  for (const char *time : {"", "soon", "nan", "inf", "-1e10", "1,2"}) expect_refusal({"render", cornell, "--time-at", time}, 2, "--time-at");
  expect_refusal({"info", cornell, "--time-at", "nan"}, 2, "--time-at");
  for (const char *open : {"", "long", "nan", "inf", "-0.1", "1,2"}) expect_refusal({"render", cornell, "--time-at", "0", "--shutter", open}, 2, "--shutter");
  for (const char *command : {"render", "info"}) expect_refusal({command, cornell, "--shutter", "0.5"}, 2, "--time-at SECONDS");
  for (const char *command : {"render", "info"}) {
    expect_refusal({command, cornell, "--animation", "walk"}, 2, "--time-at SECONDS");
    expect_refusal({command, cornell, "--animation", "walk", "--time-at", "1"}, 2, "has no animation");
  }
  for (const char *frames : {"7", "7:7", "8:7", ":7", "7:", "-1:7", "a:b", "0:1:2", "0:10000001", "0.5:2"}) expect_refusal({"render", cornell, "--frames", frames}, 2, "--frames");
  expect_refusal({"render", cornell, "--fps", "24"}, 2, "--frames");
  for (const char *fps : {"0", "-24", "nan", "1e7", "often"}) expect_refusal({"render", cornell, "--frames", "0:2", "--fps", fps}, 2, "--fps");
  expect_refusal({"render", cornell, "--frames", "0:2", "--checkpoint", "c.film"}, 2, "--checkpoint");
  expect_refusal({"render", cornell, "--frames", "0:2", "--resume", "no.film"}, 2, "--resume");
  expect_refusal({"render", cornell, "--frames", "0:2", "--update", "5"}, 2, "--update");
  expect_refusal({"render", cornell, "--frames", "0:2", "-o", "no-such-folder/a.png"}, 1, "no-such-folder");
}

TEST(Usage, OutputsThatCannotBeWritten) {
  expect_refusal({"render", cornell, "-o", "no-such-folder/out.png"}, 1, "no-such-folder");
  expect_refusal({"render", cornell, "-o", "folder.png"}, 1, "folder.png");
  expect_refusal({"render", cornell, "-o", "out.gif"}, 2, "out.gif");
  expect_refusal({"render", cornell, "-o", "out"}, 2, "out");
  expect_refusal({"render", cornell, "-o", "good.png", "-o", "out.svg"}, 2, "out.svg");
  expect_refusal({"render", cornell, "-o", "good.png", "--stats", "no-such-folder/stats.json"}, 1, "no-such-folder");
  expect_refusal({"render", cornell, "--checkpoint", "out.png"}, 2, "--checkpoint");
  expect_refusal({"render", cornell, "--checkpoint", "no-such-folder/out.film"}, 1, "no-such-folder");
  expect_refusal({"render", cornell, "--size", "8x8", "--resume", "no.film", "-o", "a.png"}, 1, "no.film");
}

TEST(Usage, HelpAndVersion) {
  for (const std::vector<std::string> &words : std::vector<std::vector<std::string>>{{"--help"}, {"--version"}, {"render", "--help"}, {"devices", "--help"}, {"info", "--help"}}) {
    const Ended ended = run_sunstone(words);
    EXPECT_EQ(ended.status, 0) << words[0];
    EXPECT_EQ(ended.error, "") << words[0];
    EXPECT_NE(ended.out.find("sunstone"), std::string::npos) << words[0];
    EXPECT_TRUE(plain_text(ended.out)) << words[0];
  }
}

TEST(Usage, StandardOutputThatIsFullIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  RunOptions run;
  run.out_to = "/dev/full";
  const Ended ended = run_sunstone({"devices"}, run);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(lines_of(ended.error, "error").size(), 1u) << ended.error;
}

}  // namespace sunstone::test
