// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace pelage {

/// One number per pixel, in rows from the top.
struct Plane {
  Plane(int columns, int rows, double value = 0);
  /// `from` has a number for each pixel.
  Plane(int columns, int rows, const std::vector<float>& from);

  double& at(int x, int y) { return pixels[index(x, y)]; }
  double at(int x, int y) const { return pixels[index(x, y)]; }

  int width, height;
  std::vector<double> pixels;

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

/// (a + b) / 2; both have the same size.
Plane mean_of(const Plane& a, const Plane& b);

/// Means of blocks of kMeanBlock x kMeanBlock pixels; an incomplete block at the right or lower border is
/// left out.
constexpr int kMeanBlock = 4;
Plane block_means(const Plane& plane);

/// Means over 2 * around + 1 pixels in both directions. Pixels beyond the border equal those at the border.
Plane blurred(const Plane& plane, int around);

/// Mean over the pixels where `region` exceeds one half; NaN without any.
double mean_over(const Plane& plane, const Plane& region);

}  // namespace pelage
