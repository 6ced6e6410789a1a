// SPDX-License-Identifier: Apache-2.0
// Every file of tests/data/malformed through the binary: it ends as the table of its README says, in time, in bounded memory, and no picture holds a number
// that is none.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "cli/process.h"
#include "support/temporary_folder.h"
#include "image/image.h"

namespace sunstone::test {
namespace {

struct Row {
  std::string file, verdict, says;
};
void PrintTo(const Row &row, std::ostream *out) { *out << row.file << " (" << row.verdict << ")"; }

const std::filesystem::path folder_of_files = std::filesystem::path(SUNSTONE_SOURCE_DIR) / "tests/data/malformed";

// Rows "| `name` | VERDICT | what is wrong | what the program says or does |".
std::vector<Row> rows() {
  std::vector<Row> out;
  std::ifstream in(folder_of_files / "README.md");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    for (std::size_t at = 2; at < line.size();) {
      const std::size_t end = std::min(line.find(" |", at), line.size());
      cells.push_back(line.substr(at, end - at));
      at = end + 3;
    }
    if (cells.size() >= 4) out.push_back({cells[0].substr(1, cells[0].size() - 2), cells[1], cells[3]});
  }
  return out;
}

Ended render(const Row &row, const TemporaryFolder &folder) {
  const std::string path = (folder_of_files / row.file).string();
  std::vector<std::string> words{"render"};
  if (row.file.find("env-") != std::string::npos) words.insert(words.end(), {(folder_of_files / "valid-minimal.glb").string(), "--env", path});
  else words.push_back(path);
  words.insert(words.end(), {"--size", "32x32", "--spp", "1", "--max-depth", "3", "-o", (folder / "out.exr").string()});
  RunOptions run;
  run.folder = folder / "";
  return run_sunstone(words, run);
}

class MalformedFile : public testing::TestWithParam<Row> {};

TEST_P(MalformedFile, EndsAsItsVerdictSays) {
  const Row &row = GetParam();
  const TemporaryFolder folder;
  Ended ended = render(row, folder);
  if (ended.seconds > 10) ended = render(row, folder);  // the first of its kind may have waited for a compiler
  EXPECT_LT(ended.seconds, 10);
  EXPECT_FALSE(ended.timed_out);
  EXPECT_EQ(ended.signal, 0) << "ended by a signal";
  EXPECT_LT(ended.peak_kilobytes, 2l << 20);
  EXPECT_TRUE(plain_text(ended.error)) << ended.error;
  EXPECT_TRUE(plain_text(ended.out)) << ended.out;
  EXPECT_EQ(ended.error.find("unexpected"), std::string::npos) << ended.error;
  const std::vector<std::string> errors = lines_of(ended.error, "error"), warnings = lines_of(ended.error, "warning");
  const bool rendered = ended.status == 0;

  if (row.verdict == "VALID") {
    EXPECT_TRUE(rendered) << ended.error;
    if (row.says.find("no warning") != std::string::npos) {
      EXPECT_TRUE(warnings.empty()) << ended.error;
    }
  }
  if (row.verdict == "REFUSE" && row.says.find("(or warn") == std::string::npos) {
    EXPECT_FALSE(rendered);
  }
  if (row.verdict == "WARN" && rendered) {
    EXPECT_FALSE(warnings.empty()) << "it says nothing";
  }
  if (rendered) {
    EXPECT_TRUE(errors.empty()) << ended.error;
    ASSERT_EQ(listing(folder / ""), (std::vector<std::string>{"out.exr"}));
    const Image image = read_image(folder / "out.exr");
    EXPECT_EQ(image.width, 32);
    EXPECT_EQ(image.height, 32);
    std::size_t bad = 0;
    for (const float value : std::get<std::vector<float>>(image.pixels)) bad += !(std::isfinite(value) && value >= 0);
    EXPECT_EQ(bad, 0u) << "pixels that are not finite, or negative";
  } else {
    EXPECT_EQ(ended.status, 1) << ended.error;
    ASSERT_EQ(errors.size(), 1u) << ended.error;
    EXPECT_NE(errors[0].find(row.file), std::string::npos) << "it does not name the file: " << errors[0];
    EXPECT_EQ(listing(folder / ""), std::vector<std::string>{}) << "it left something behind";
  }
  for (const std::string &warning : warnings) EXPECT_LT(warning.size(), 2000u);
}

INSTANTIATE_TEST_SUITE_P(Files, MalformedFile, testing::ValuesIn(rows()), [](const testing::TestParamInfo<Row> &info) {
  std::string name = info.param.file;
  for (char &c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(MalformedTable, HasEveryFile) { EXPECT_EQ(rows().size(), 100u); }

}  // namespace
}  // namespace sunstone::test
