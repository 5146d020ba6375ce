// SPDX-License-Identifier: Apache-2.0
#include "render/frame/coat_shell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pelage {

CoatShell fit_shell(std::span<const ShellRay> rays) {
  if (rays.empty()) return {};
  std::vector<float> heights;
  for (const ShellRay& ray : rays)
    heights.push_back((ray.origin - ray.ball.center).length() - ray.ball.radius);
  const size_t rank = heights.size() * 95 / 100;
  std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(rank), heights.end());
  CoatShell shell{heights[rank], 0};
  if (!(shell.thickness > 0)) return {};
  std::vector<double> ways;
  for (const ShellRay& ray : rays) ways.push_back(shell.way(ray.ball, ray.origin, ray.direction, ray.far));
  // The error may have several minima, so the density is searched in small steps: 2 % each, from an optical
  // thickness of 0.01 to one of 1000.
  double best = std::numeric_limits<double>::max();
  for (double thickness = 0.01; thickness < 1000; thickness *= 1.02) {
    double error = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const double off = rays[i].through - std::exp(-thickness / shell.thickness * ways[i]);
      error += off * off;
    }
    if (error < best) {
      best = error;
      shell.density = static_cast<float>(thickness / shell.thickness);
    }
  }
  return shell;
}

}  // namespace pelage
