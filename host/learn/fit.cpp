// SPDX-License-Identifier: Apache-2.0
#include "learn/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sunstone {

Line fit_line(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  if (n != y.size() || n < 2) throw Error("fit", "takes two points at least, an x and a y each");
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < n; i++) {
    mean_x += x[i] / static_cast<double>(n);
    mean_y += y[i] / static_cast<double>(n);
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < n; i++) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(xx > 0) || !std::isfinite(xy)) throw Error("fit", "points of one x, or not finite, have no slope");
  Line line;
  line.slope = xy / xx;
  line.intercept = mean_y - line.slope * mean_x;
  double residuals = 0;
  for (std::size_t i = 0; i < n; i++) {
    const double r = y[i] - line.intercept - line.slope * x[i];
    residuals += r * r;
  }
  if (n > 2) line.slope_error = std::sqrt(residuals / static_cast<double>(n - 2) / xx);
  return line;
}

Line fit_power(std::span<const double> x, std::span<const double> y) {
  std::vector<double> log_x, log_y;
  for (const double value : x) log_x.push_back(std::log(value));
  for (const double value : y) log_y.push_back(std::log(value));
  return fit_line(log_x, log_y);
}

std::vector<double> linear_ticks(double low, double high, std::size_t most) {
  if (!(low < high) || most < 2) return {low};
  const double rough = (high - low) / static_cast<double>(most - 1);
  double step = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0})
    if (step * factor >= rough * (1 - 1e-9)) {
      step *= factor;
      break;
    }
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push_back(k * step == 0 ? 0.0 : k * step);
  return ticks;
}

std::vector<double> log_ticks(double low, double high, std::size_t most) {
  if (!(low > 0) || !(high >= low)) return {};
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9)), last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  const int every = std::max(1, static_cast<int>(std::ceil(static_cast<double>(last - first + 1) / static_cast<double>(most))));
  std::vector<double> ticks;
  for (int power = first; power <= last; power++)
    if (power % every == 0) ticks.push_back(std::pow(10.0, power));
  return ticks;
}

static std::string power_of_ten(int power) {
  static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = power < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(power))) text += digits[c - '0'];
  return text;
}

std::string show_number(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  if (value < 0) return "−" + show_number(-value, digits);
  if (value == 0) return "0";
  if (value >= 0.001 && value < 1e7) {
    const int whole = static_cast<int>(std::floor(std::log10(value))) + 1;
    std::string text = fmt::format("{:.{}f}", value, std::max(0, digits - whole));
    if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
    // Thousands apart, by a narrow space that does not break.
    std::size_t at = std::min(text.find('.'), text.size());
    if (at > 3)
      for (; at > 3; at -= 3) text.insert(at - 3, "\u202f");
    return text;
  }
  int power = static_cast<int>(std::floor(std::log10(value)));
  std::string mantissa = fmt::format("{:.{}f}", value / std::pow(10.0, power), digits - 1);
  if (mantissa.starts_with("10")) mantissa = fmt::format("{:.{}f}", 1.0, digits - 1), power++;
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return mantissa == "1" ? power_of_ten(power) : mantissa + "·" + power_of_ten(power);
}

}  // namespace sunstone
