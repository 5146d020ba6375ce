// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/line_fit.h"

#include <algorithm>
#include <cmath>

namespace pelage {

double LineFit::error_at(double x) const {
  return residual * std::sqrt(1 / count + (x - mean) * (x - mean) / spread);
}

LineFit fit_line(std::span<const std::pair<double, double>> points) {
  LineFit fit;
  fit.count = static_cast<double>(points.size());
  double mean_y = 0, product = 0;
  for (const auto& [x, y] : points) {
    fit.mean += x / fit.count;
    mean_y += y / fit.count;
  }
  for (const auto& [x, y] : points) {
    fit.spread += (x - fit.mean) * (x - fit.mean);
    product += (x - fit.mean) * (y - mean_y);
  }
  if (!(fit.spread > 0)) return {NAN, NAN, NAN, NAN, NAN, fit.count};
  fit.slope = product / fit.spread;
  fit.at_zero = mean_y - fit.slope * fit.mean;
  double squares = 0;
  for (const auto& [x, y] : points) squares += (y - fit.at(x)) * (y - fit.at(x));
  fit.residual = points.size() > 2 ? std::sqrt(squares / (fit.count - 2)) : 0;
  return fit;
}

}  // namespace pelage
