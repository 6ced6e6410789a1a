// SPDX-License-Identifier: Apache-2.0
// Plots as SVG text: lines over linear or logarithmic axes, and bars. One string, which stands alone as a file and inline in a page, light or dark.
#pragma once
#include <string>
#include <vector>

namespace sunstone {

struct Axis {
  std::string label;
  bool log = false;
};

struct Series {
  std::string name;  // in the legend
  std::vector<double> x, y;
  bool markers = true, dashed = false;
};

// Values that a logarithmic axis cannot show (0 and below, not finite) are left out. Throws Error where nothing is left to show.
std::string line_plot(const std::string &title, const Axis &x, const Axis &y, const std::vector<Series> &series);

struct Bars {
  std::string name;
  std::vector<double> values;  // one a label, not negative
};

// Groups of bars from 0: `labels` along the axis, a colour each of `series`.
std::string bar_plot(const std::string &title, const std::string &x_label, const Axis &y, const std::vector<std::string> &labels, const std::vector<Bars> &series);

// `text` with what SVG and HTML take for markup escaped.
std::string escaped(const std::string &text);

}  // namespace sunstone
