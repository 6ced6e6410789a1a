// SPDX-License-Identifier: Apache-2.0
// Plots, read back from their own SVG.
#include "learn/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "base/error.h"

namespace sunstone {

namespace {

// Points of the path of one series.
std::vector<std::pair<double, double>> points_of(const std::string &svg, int series) {
  const std::string opening = "<g data-series='" + std::to_string(series) + "'><path class='line'";
  const std::size_t at = svg.find(opening);
  if (at == std::string::npos) return {};
  const std::size_t begin = svg.find(" d='", at) + 4, end = svg.find('\'', begin);
  std::vector<std::pair<double, double>> points;
  const std::string path = svg.substr(begin, end - begin);
  const std::regex number("[ML]([0-9.]+) ([0-9.]+)");
  for (std::sregex_iterator i(path.begin(), path.end(), number), none; i != none; ++i) points.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  return points;
}

std::size_t count(const std::string &text, const std::string &word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) found++;
  return found;
}

// Every element that is opened is closed, in order.
void expect_well_formed(const std::string &svg) {
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z]+)([^<>]*?)(/?)>");
  for (std::sregex_iterator i(svg.begin(), svg.end(), tag), none; i != none; ++i) {
    const std::string name = (*i)[2];
    if ((*i)[1] == "/") {
      ASSERT_FALSE(open.empty()) << name;
      EXPECT_EQ(open.back(), name);
      open.pop_back();
    } else if ((*i)[4] != "/") {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty());
}

}  // namespace

TEST(Plot, APowerIsAStraightLineOverLogarithms) {
  std::vector<double> x, y;
  for (double n = 1; n <= 1e4; n *= 10) x.push_back(n), y.push_back(std::pow(n, -0.5));
  const std::string svg = line_plot("Error", {"samples", true}, {"RMSE", true}, {{"measured", x, y}});
  expect_well_formed(svg);
  const auto points = points_of(svg, 0);
  ASSERT_EQ(points.size(), 5u);
  // Four decades across and two down: both axes begin and end at powers of ten.
  const double across = (points[4].first - points[0].first) / 4, down = (points[4].second - points[0].second) / 4;
  EXPECT_GT(across, 100);
  EXPECT_GT(down, 50);
  for (std::size_t i = 1; i < 5; i++) {
    EXPECT_NEAR(points[i].first - points[i - 1].first, across, 0.11);
    EXPECT_NEAR(points[i].second - points[i - 1].second, down, 0.11);
  }
  EXPECT_NE(svg.find(">measured</text>"), std::string::npos);
  EXPECT_NE(svg.find(">0.01</text>"), std::string::npos) << svg;
}

TEST(Plot, LinearAxesAndValuesThatCannotBeShown) {
  const std::string svg = line_plot("Line", {"x", false}, {"y", false}, {{"a", {0, 5, 10}, {0, 50, 100}}, {"b <i>", {0, 10}, {100, 0}, false, true}});
  expect_well_formed(svg);
  const auto points = points_of(svg, 0);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].first, (points[0].first + points[2].first) / 2, 0.11);
  EXPECT_NEAR(points[1].second, (points[0].second + points[2].second) / 2, 0.11);
  EXPECT_GT(points[0].second, points[2].second) << "larger values stand higher";
  EXPECT_EQ(svg.find("<i>"), std::string::npos);
  EXPECT_NE(svg.find("b &lt;i&gt;"), std::string::npos);
  EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos);
  const std::string some = line_plot("Log", {"x", true}, {"y", true}, {{"a", {0, 1, 10, 100}, {1, 1, -1, 10}}});
  EXPECT_EQ(points_of(some, 0).size(), 2u);
  EXPECT_THROW(line_plot("None", {"x", true}, {"y", true}, {{"a", {0}, {1}}}), Error);
  EXPECT_THROW(line_plot("Odd", {"x", false}, {"y", false}, {{"a", {0, 1}, {1}}}), Error);
}

TEST(Plot, BarsAreAsHighAsTheirValues) {
  const std::string svg = bar_plot("Bars", "depth", {"share", false}, {"0", "1", "2"}, {{"light", {1, 2, 4}}, {"rays", {4, 0, 4}}});
  expect_well_formed(svg);
  std::vector<double> heights;
  const std::regex bar("<rect x='[0-9.]+' y='[0-9.]+' width='[0-9.]+' height='([0-9.]+)'/>");
  for (std::sregex_iterator i(svg.begin(), svg.end(), bar), none; i != none; ++i) heights.push_back(std::stod((*i)[1]));
  ASSERT_EQ(heights.size(), 6u);
  EXPECT_GT(heights[0], 40);
  EXPECT_NEAR(heights[1], 2 * heights[0], 0.21);
  EXPECT_NEAR(heights[2], 4 * heights[0], 0.41);
  EXPECT_EQ(heights[4], 0);
  EXPECT_EQ(count(svg, ">light</text>"), 1u);
  EXPECT_THROW(bar_plot("Odd", "x", {"y", false}, {"0", "1"}, {{"a", {1}}}), Error);
}

}  // namespace sunstone
