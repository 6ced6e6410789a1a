// SPDX-License-Identifier: Apache-2.0
#include "learn/page.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "support/temporary_folder.h"

namespace sunstone {

namespace {

std::string read(const std::filesystem::path &path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::byte> bytes(const std::string &text) {
  std::vector<std::byte> data;
  for (const char c : text) data.push_back(static_cast<std::byte>(c));
  return data;
}

}  // namespace

// RFC 4648, section 10.
TEST(Page, Base64) {
  const char *const pairs[][2] = {{"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}};
  for (const auto &[plain, coded] : pairs) EXPECT_EQ(base64(bytes(plain)), coded);
  EXPECT_EQ(base64({std::byte{0xff}, std::byte{0xfe}, std::byte{0xfd}}), "//79");
}

TEST(Page, StandsAloneAndEscapes) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "dot.png") << "not looked into";
  Page page("A <title> & more", "lead with `code < 1`");
  page.pictures({{folder / "dot.png", "a 'caption'"}});
  page.table({{"a", "b"}, {{"<1>", "2"}}});
  page.folded("open", {{"c"}, {{"3"}}});
  page.write(folder / "page.html");
  const std::string text = read(folder / "page.html");
  EXPECT_TRUE(text.starts_with("<!DOCTYPE html>"));
  EXPECT_NE(text.find("<title>A &lt;title&gt; &amp; more</title>"), std::string::npos);
  EXPECT_NE(text.find("<code>code &lt; 1</code>"), std::string::npos);
  EXPECT_NE(text.find("src='data:image/png;base64,bm90IGxvb2tlZCBpbnRv'"), std::string::npos);
  EXPECT_NE(text.find("<td>&lt;1&gt;</td>"), std::string::npos);
  EXPECT_NE(text.find("prefers-color-scheme:dark"), std::string::npos);
  for (const char *word : {"http", "//", "<script", "<link", "@import"}) EXPECT_EQ(text.find(word), std::string::npos) << word;
}

// Numbers end under each other and words begin so; a negative number has a minus sign, a flag its hyphens; pictures stand in rows of about the same length.
TEST(Page, ReadsWell) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "dot.png") << "not looked into";
  const Picture dot{folder / "dot.png", "dot"};
  Page page("t", "from -1.5 to (-2), `-3` and --flag");
  page.table({{"a", "number", "word", "flag"}, {{"x", "-0.5", "left", "`--f 1`"}, {"y", "+2", "right 3 way", "`--g 2`"}}});
  page.pictures({dot, dot, dot, dot, dot});
  page.pictures({dot, dot, dot, dot, dot}, 5);
  page.pictures({dot, dot});
  page.write(folder / "page.html");
  const std::string text = read(folder / "page.html");
  EXPECT_NE(text.find("from −1.5 to (−2), <code>-3</code> and --flag"), std::string::npos) << text;
  EXPECT_NE(text.find("<th>number</th><th class='words'>word</th><th class='words'>flag</th>"), std::string::npos) << text;
  EXPECT_NE(text.find("<td>−0.5</td><td class='words'>left</td><td class='words'><code>--f 1</code></td>"), std::string::npos) << text;
  const std::size_t three = text.find("--n:3'"), five = text.find("--n:5'"), two = text.find("--n:2'");
  EXPECT_TRUE(three < five && five < two && two != std::string::npos) << "rows of three and two, of five, of two";
}

TEST(Page, CsvQuotesWhatNeedsIt) {
  const test::TemporaryFolder folder;
  write_csv(folder / "a.csv", {{"x", "says, \"so\""}, {{"1", "plain"}, {"2", "two\nlines"}}});
  EXPECT_EQ(read(folder / "a.csv"), "x,\"says, \"\"so\"\"\"\n1,plain\n2,\"two\nlines\"\n");
  EXPECT_THROW(write_csv(folder / "b.csv", {{"x", "y"}, {{"1"}}}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.csv"));
}

}  // namespace sunstone
