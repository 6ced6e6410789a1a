// SPDX-License-Identifier: Apache-2.0
#include "support/agree.h"

#include <cmath>

#include "support/statistics.h"

namespace sunstone::test {

Agreement agreement(const std::vector<Film> &a, const std::vector<Film> &b, const std::vector<std::string> &layers, int block, double false_alarms) {
  std::vector<double> p;
  std::vector<std::string> name;
  std::vector<Window> windows{whole(a.at(0))};
  for (int y = 0; y + block <= a[0].height(); y += block)
    for (int x = 0; x + block <= a[0].width(); x += block) windows.push_back({x, y, x + block, y + block});
  for (const std::string &layer : layers)
    for (const Window &window : windows)
      for (int channel = 0; channel < 3; channel++) {
        const std::vector<double> of_a = means(a, layer, window, channel), of_b = means(b, layer, window, channel);
        p.push_back(welch(of_a, of_b));
        name.push_back(layer + " from " + std::to_string(window.x0) + "," + std::to_string(window.y0) + " to " + std::to_string(window.x1) + "," + std::to_string(window.y1) + " channel " +
                       std::to_string(channel) + ": " + std::to_string(moments(of_a).mean) + " and " + std::to_string(moments(of_b).mean));
      }
  Agreement result;
  const std::vector<std::size_t> rejected = holm_rejected(p, false_alarms);
  result.means = p.size();
  result.rejected = rejected.size();
  for (std::size_t i = 0; i < rejected.size() && i < 12; i++) result.what += "\n  " + name[rejected[i]] + ", p = " + std::to_string(p[rejected[i]]);
  return result;
}

std::vector<std::string> bounces(unsigned first, unsigned last) {
  std::vector<std::string> names;
  for (unsigned depth = first; depth <= last; depth++) names.push_back("bounce." + std::to_string(depth));
  return names;
}

double relative_error(const std::vector<Film> &films, const std::string &layer) {
  const Moments m = moments(means(films, layer, whole(films.at(0)), 1));
  return std::sqrt(m.variance / static_cast<double>(m.count)) / m.mean;
}

}  // namespace sunstone::test
