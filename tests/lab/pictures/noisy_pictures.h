// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "base/hash.h"
#include "image/exr.h"

namespace pelage {

/// Value of a pixel, the same in R, G and B.
using PixelValue = std::function<double(int x, int y)>;

/// A picture in which everything is fur: `value` plus uniform noise of standard deviation `noise`, which
/// depends on `seed` and differs between R, G and B.
inline ExrImage fur_picture(int width, int height, const PixelValue& value, double noise, uint64_t seed) {
  ExrImage image;
  image.width = width;
  image.height = height;
  uint64_t draw = 0;
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, ChannelType::kFloat, {}, {}});
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x)
        image.channels.back().pixels.push_back(
            static_cast<float>(value(x, y) + noise * std::sqrt(3.0) * signed_float(hash64(seed, draw++))));
    }
  }
  const auto pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (const char* name : {"A", "tangent.X", "tangent.Y", "tangent.Z"}) {
    const float layer = std::string(name) == "tangent.Y" || std::string(name) == "tangent.Z" ? 0.0f : 1.0f;
    image.channels.push_back({name, ChannelType::kFloat, std::vector<float>(pixels, layer), {}});
  }
  return image;
}

}  // namespace pelage
