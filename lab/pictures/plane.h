// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace pelage {

/// An image with one number per pixel. Rows are stored from the top.
struct Plane {
  /// Makes an image in which every pixel is `value`.
  Plane(int columns, int rows, double value = 0);
  /// Makes an image from `from`, which holds one number per pixel.
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

/// Returns (a + b) / 2, pixel by pixel. The images must have the same size.
Plane mean_of(const Plane& a, const Plane& b);

/// Returns the means of the blocks of size x size pixels of an image. Omits incomplete blocks at the right
/// and lower borders.
Plane block_means(const Plane& plane, int size);

/// Box filter: returns for each pixel the mean over the square window centred on it, whose width is 2 *
/// around + 1 pixels. Outside the image, the pixels at the border are repeated.
Plane blurred(const Plane& plane, int around);

/// Returns the mean over the pixels where `region` is greater than 0.5; NaN if there are none.
double mean_over(const Plane& plane, const Plane& region);

}  // namespace pelage
