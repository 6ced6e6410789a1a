// SPDX-License-Identifier: Apache-2.0
#include "learn/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "learn/fit.h"

namespace sunstone {

namespace {

// In units of the picture: where the axes stand, with room for labels around them.
constexpr double width = 744, left = 84, right = 700, top = 40, bottom = 344, label_y = 388, legend_y = 412, legend_row = 20;
constexpr std::size_t most_ticks = 8, colours = 6;

// Colours that colour-blind readers tell apart (Okabe and Ito), lighter ones on a dark page; the rest follows the page's ink.
constexpr const char *style =
    "<style>.plot{font:13px system-ui,sans-serif;--ink:#222;--grid:#ddd;--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#aa4499;--c4:#b8860b;--c5:#555}"
    "@media(prefers-color-scheme:dark){.plot{--ink:#ddd;--grid:#444;--c0:#56b4e9;--c1:#ff8c42;--c2:#3fd1a4;--c3:#e79ac9;--c4:#f0c04a;--c5:#aaa}}"
    ".plot text{fill:var(--ink)}.plot .axis{stroke:var(--ink);fill:none}.plot .grid{stroke:var(--grid);fill:none}"
    ".plot .line{fill:none;stroke-width:2}.plot .title{font-weight:600}</style>";

class Scale {
 public:
  Scale(const Axis &axis, double low, double high, double from, double to) : axis_(axis), from_(from), to_(to) {
    if (axis.log) {
      // Out to whole decades, so that both ends are ticks, unless all lies within a small part of one.
      low_ = std::floor(std::log10(low) + 1e-9);
      high_ = std::ceil(std::log10(high) - 1e-9);
      if (high_ <= low_) high_ = low_ + 1;
    } else {
      low_ = low;
      high_ = high > low ? high : low + 1;
      const std::vector<double> ticks = linear_ticks(low_, high_, most_ticks);
      if (ticks.size() > 1) {
        const double step = ticks[1] - ticks[0];
        low_ = std::floor(low_ / step + 1e-9) * step;
        high_ = std::ceil(high_ / step - 1e-9) * step;
      }
    }
  }
  bool shows(double value) const { return std::isfinite(value) && (!axis_.log || value > 0); }
  double at(double value) const { return from_ + (to_ - from_) * ((axis_.log ? std::log10(value) : value) - low_) / (high_ - low_); }
  double foot() const { return axis_.log ? std::pow(10.0, low_) : std::max(0.0, low_); }
  std::vector<double> ticks() const { return axis_.log ? log_ticks(std::pow(10.0, low_), std::pow(10.0, high_), most_ticks) : linear_ticks(low_, high_, most_ticks); }

 private:
  Axis axis_;
  double from_, to_, low_, high_;
};

std::string colour(std::size_t index) { return fmt::format("var(--c{})", index % colours); }

// A shape of its own for each series, so that colour is not all that tells them apart.
std::string marker(std::size_t index, double x, double y) {
  switch (index % 3) {
    case 0: return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}'/>", x, y, colour(index));
    case 1: return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='6.4' height='6.4' fill='{}'/>", x - 3.2, y - 3.2, colour(index));
    default: return fmt::format("<path d='M{:.1f} {:.1f}l4 7h-8z' fill='{}'/>", x, y - 4.5, colour(index));
  }
}

std::string text_at(double x, double y, const char *anchor, const std::string &text, const char *more = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'{}>{}</text>", x, y, anchor, more, escaped(text));
}

std::string opening(const std::string &title, std::size_t legend_entries) {
  const double height = legend_y + legend_row * static_cast<double>((legend_entries + 1) / 2) + 4;
  return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' class='plot' viewBox='0 0 {} {:.0f}' role='img' aria-label='{}'>{}", width, height, escaped(title), style) +
         text_at(width / 2, 22, "middle", title, " class='title'");
}

std::string vertical_axis(const Scale &scale, const Axis &axis) {
  std::string svg;
  for (const double tick : scale.ticks()) {
    const double y = scale.at(tick);
    svg += fmt::format("<path class='grid' d='M{} {:.1f}H{}'/>", left, y, right) + text_at(left - 8, y + 4.5, "end", show_number(tick));
  }
  const double middle = (top + bottom) / 2;
  return svg + fmt::format("<text x='18' y='{0}' text-anchor='middle' transform='rotate(-90 18 {0})'>{1}</text>", middle, escaped(axis.label));
}

std::string frame(const std::string &x_label) {
  return fmt::format("<path class='axis' d='M{} {}V{}H{}'/>", left, top, bottom, right) + text_at((left + right) / 2, label_y, "middle", x_label);
}

std::string legend_entry(std::size_t index, std::size_t row, const std::string &sign, const std::string &name) {
  const double x = row % 2 ? (left + right) / 2 : left, y = legend_y + legend_row * static_cast<double>(row / 2);
  return fmt::format("<g data-series='{}' transform='translate({:.1f} {:.1f})'>{}</g>", index, x, y, sign) + text_at(x + 34, y + 4.5, "start", name);
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

}  // namespace

std::string escaped(const std::string &text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else if (c == '"') result += "&quot;";
    else if (c == '\'') result += "&#39;";
    else result += c;
  }
  return result;
}

std::string line_plot(const std::string &title, const Axis &x, const Axis &y, const std::vector<Series> &series) {
  const auto shown = [&](double vx, double vy) { return std::isfinite(vx) && std::isfinite(vy) && (!x.log || vx > 0) && (!y.log || vy > 0); };
  Range across, up;
  for (const Series &s : series) {
    if (s.x.size() != s.y.size()) throw Error("plot " + title, "series " + s.name + " has not as many x as y");
    for (std::size_t i = 0; i < s.x.size(); i++)
      if (shown(s.x[i], s.y[i])) across.take(s.x[i]), up.take(s.y[i]);
  }
  if (!(across.low <= across.high)) throw Error("plot " + title, "has no value that its axes can show");
  const Scale sx(x, across.low, across.high, left, right), sy(y, up.low, up.high, bottom, top);
  std::string svg = opening(title, series.size()) + vertical_axis(sy, y);
  for (const double tick : sx.ticks()) {
    const double at = sx.at(tick);
    svg += fmt::format("<path class='grid' d='M{:.1f} {}V{}'/>", at, top, bottom) + text_at(at, bottom + 20, "middle", show_number(tick));
  }
  svg += frame(x.label);
  for (std::size_t i = 0; i < series.size(); i++) {
    const Series &s = series[i];
    const char *dashes = s.dashed ? " stroke-dasharray='7 5'" : "";
    std::string path, points;
    for (std::size_t k = 0; k < s.x.size(); k++) {
      if (!shown(s.x[k], s.y[k])) continue;
      const double px = sx.at(s.x[k]), py = sy.at(s.y[k]);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
      if (s.markers) points += marker(i, px, py);
    }
    svg += fmt::format("<g data-series='{}'><path class='line' stroke='{}'{} d='{}'/>{}</g>", i, colour(i), dashes, path, points);
    svg += legend_entry(i, i, fmt::format("<path class='line' stroke='{}'{} d='M0 0H28'/>", colour(i), dashes) + (s.markers ? marker(i, 14, 0) : ""), s.name);
  }
  return svg + "</svg>\n";
}

std::string bar_plot(const std::string &title, const std::string &x_label, const Axis &y, const std::vector<std::string> &labels, const std::vector<Bars> &series) {
  Range up;
  for (const Bars &bars : series) {
    if (bars.values.size() != labels.size()) throw Error("plot " + title, "bars " + bars.name + " are not as many as the labels");
    for (const double value : bars.values)
      if (std::isfinite(value) && (!y.log || value > 0)) up.take(value);
  }
  if (!(up.low <= up.high)) throw Error("plot " + title, "has no value that its axis can show");
  const Scale scale(y, y.log ? up.low : std::min(0.0, up.low), up.high, bottom, top);
  const double foot = scale.at(scale.foot());
  std::string svg = opening(title, series.size()) + vertical_axis(scale, y);
  const double group = (right - left) / static_cast<double>(std::max<std::size_t>(1, labels.size())), bar = group * 0.76 / static_cast<double>(series.size());
  for (std::size_t i = 0; i < labels.size(); i++) svg += text_at(left + group * (static_cast<double>(i) + 0.5), bottom + 20, "middle", labels[i]);
  for (std::size_t k = 0; k < series.size(); k++) {
    svg += fmt::format("<g data-series='{}' fill='{}'>", k, colour(k));
    for (std::size_t i = 0; i < labels.size(); i++) {
      const double value = series[k].values[i];
      if (!scale.shows(value)) continue;
      const double x = left + group * (static_cast<double>(i) + 0.12) + bar * static_cast<double>(k), y_top = scale.at(value);
      svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>", x, y_top, bar * 0.94, std::max(0.0, foot - y_top));
    }
    svg += "</g>" + legend_entry(k, k, fmt::format("<rect x='4' y='-7' width='20' height='14' fill='{}'/>", colour(k)), series[k].name);
  }
  return svg + frame(x_label) + "</svg>\n";
}

}  // namespace sunstone
