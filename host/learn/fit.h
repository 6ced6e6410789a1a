// SPDX-License-Identifier: Apache-2.0
// Lines through points, and where an axis has its ticks.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace sunstone {

struct Line {
  double slope = 0, intercept = 0;
  double slope_error = 0;  // one standard deviation, from the residuals; 0 where there are two points
};

// By least squares. Needs two points of different x.
Line fit_line(std::span<const double> x, std::span<const double> y);

// y = e^intercept x^slope: the line of the logarithms. All values have to be positive.
Line fit_power(std::span<const double> x, std::span<const double> y);

// Round numbers (1, 2 or 5 times a power of ten) from `low` to `high`, about `most` of them and no more.
std::vector<double> linear_ticks(double low, double high, std::size_t most);

// Powers of ten within [low, high]; every second, third ... of them where there would be more than `most`. 0 < low <= high.
std::vector<double> log_ticks(double low, double high, std::size_t most);

// A number as it stands at an axis or in a table: "0.25", "1 024", "10⁻⁴", with `digits` significant ones at most.
std::string show_number(double value, int digits = 4);

}  // namespace sunstone
