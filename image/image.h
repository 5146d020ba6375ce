// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace pelage {

/// An image of linear floating-point pixels. Rows run from the top; the channels of a pixel are adjacent.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> pixels;  ///< width * height * channels values

  const float* at(int x, int y) const {
    return &pixels[(static_cast<size_t>(y) * width + x) * static_cast<size_t>(channels)];
  }
  float* at(int x, int y) { return const_cast<float*>(static_cast<const Image*>(this)->at(x, y)); }
  size_t bytes() const { return pixels.size() * sizeof(float); }
};

}  // namespace pelage
