// SPDX-License-Identifier: Apache-2.0
#include "image/texture.h"

#include <cmath>

#include "base/check.h"

namespace pelage {
namespace {

/// Sample positions and weight of a bilinear lookup along one axis of `size` texels, repeated.
struct Tap {
  int a = 0, b = 0;
  float t = 0;
};

Tap tap(float coordinate, int size) {
  if (!std::isfinite(coordinate)) return {};
  const float wrapped = coordinate - std::floor(coordinate);
  const float x = wrapped * static_cast<float>(size) - 0.5f;
  const int i = static_cast<int>(std::floor(x));  // -1 .. size - 1, or size where wrapped rounds to 1
  return {(i + size) % size, (i + 1) % size, x - std::floor(x)};
}

float bilinear(const Image& image, const Tap& x, const Tap& y, int channel) {
  const float low = image.at(x.a, y.a)[channel] * (1 - x.t) + image.at(x.b, y.a)[channel] * x.t;
  const float high = image.at(x.a, y.b)[channel] * (1 - x.t) + image.at(x.b, y.b)[channel] * x.t;
  return low * (1 - y.t) + high * y.t;
}

}  // namespace

float Texture::channel(float u, float v, int channel) const {
  PELAGE_CHECK(channel >= 0 && channel < image_.channels);
  return bilinear(image_, tap(u, image_.width), tap(1 - v, image_.height), channel);
}

Rgb Texture::color(float u, float v) const {
  const Tap x = tap(u, image_.width), y = tap(1 - v, image_.height);
  if (image_.channels < 3) return Rgb(bilinear(image_, x, y, 0));
  return {bilinear(image_, x, y, 0), bilinear(image_, x, y, 1), bilinear(image_, x, y, 2)};
}

}  // namespace pelage
