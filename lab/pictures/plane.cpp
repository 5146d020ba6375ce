// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/plane.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {

Plane::Plane(int columns, int rows, double value)
    : width(columns), height(rows), pixels(static_cast<size_t>(columns) * static_cast<size_t>(rows), value) {}

Plane::Plane(int columns, int rows, const std::vector<float>& from)
    : width(columns), height(rows), pixels(from.begin(), from.end()) {
  PELAGE_CHECK(pixels.size() == static_cast<size_t>(columns) * static_cast<size_t>(rows));
}

Plane mean_of(const Plane& a, const Plane& b) {
  Plane mean = a;
  for (size_t p = 0; p < mean.pixels.size(); ++p) mean.pixels[p] = 0.5 * (a.pixels[p] + b.pixels[p]);
  return mean;
}

Plane block_means(const Plane& plane, int size) {
  Plane means(plane.width / size, plane.height / size);
  for (int y = 0; y < means.height * size; ++y) {
    for (int x = 0; x < means.width * size; ++x)
      means.at(x / size, y / size) += plane.at(x, y) / (size * size);
  }
  return means;
}

Plane blurred(const Plane& plane, int around) {
  const double count = 2 * around + 1;
  Plane rows(plane.width, plane.height), both = rows;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      for (int i = -around; i <= around; ++i)
        rows.at(x, y) += plane.at(std::clamp(x + i, 0, plane.width - 1), y) / count;
    }
  }
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      for (int i = -around; i <= around; ++i)
        both.at(x, y) += rows.at(x, std::clamp(y + i, 0, plane.height - 1)) / count;
    }
  }
  return both;
}

double mean_over(const Plane& plane, const Plane& region) {
  double sum = 0, count = 0;
  for (size_t p = 0; p < plane.pixels.size(); ++p) {
    if (!(region.pixels[p] > 0.5)) continue;
    sum += plane.pixels[p];
    ++count;
  }
  return sum / count;
}

}  // namespace pelage
