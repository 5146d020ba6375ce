// SPDX-License-Identifier: Apache-2.0
#include "render/light/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "render/light/guided_cdf.h"
#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr double kPiD = std::numbers::pi;

void check_image(const Image& image) {
  if (image.width < 1 || image.height < 1 || image.channels < 1) {
    throw Error(ErrorKind::kInput, "the environment image is empty");
  }
  const int channels = image.channels < 3 ? 1 : 3;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* pixel = image.at(x, y);
      for (int c = 0; c < channels; ++c) {
        if (!std::isfinite(pixel[c])) {
          throw Error(ErrorKind::kInput, "the environment image is not finite at pixel " + std::to_string(x) +
                                             ", " + std::to_string(y));
        }
      }
    }
  }
}

}  // namespace

EnvironmentMap::EnvironmentMap(const Image& image, const Rgb& factor) : image_(image), factor_(factor) {
  check_image(image);
  const size_t width = image.width, height = image.height;
  row_cosine_.resize(height + 1);
  for (size_t y = 0; y <= height; ++y) {
    row_cosine_[y] = std::cos(kPiD * static_cast<double>(y) / static_cast<double>(height));
  }
  row_cdf_.resize(height);
  row_guide_.resize(guide_size(height));
  column_cdf_.resize(width * height);
  column_guide_size_ = guide_size(width);
  column_guide_.resize(column_guide_size_ * height);
  for (size_t y = 0; y < height; ++y) {
    const std::span<float> row(&column_cdf_[y * width], width);
    for (size_t x = 0; x < width; ++x) {
      row[x] = luminance(radiance({static_cast<int>(x), static_cast<int>(y)}));
    }
    const double sum = make_guided_cdf(row, {&column_guide_[y * column_guide_size_], column_guide_size_});
    const double power = sum * texel_solid_angle(static_cast<int>(y));
    row_cdf_[y] = static_cast<float>(power);
    power_ += power;
  }
  make_guided_cdf(row_cdf_, row_guide_);
  inverse_power_ = power_ > 0 ? static_cast<float>(1 / power_) : 0.0f;
}

double EnvironmentMap::texel_solid_angle(int row) const {
  return 2 * kPiD / image_.width * (row_cosine_[row] - row_cosine_[row + 1]);
}

size_t EnvironmentMap::bytes() const {
  return row_cosine_.size() * sizeof(double) + (row_cdf_.size() + column_cdf_.size()) * sizeof(float) +
         (row_guide_.size() + column_guide_.size()) * sizeof(uint32_t);
}

Rgb EnvironmentMap::radiance(Texel texel) const {
  const float* pixel = image_.at(texel.x, texel.y);
  const auto positive = [](float v) { return std::max(0.0f, v); };
  if (image_.channels < 3) return factor_ * positive(pixel[0]);
  return factor_ * Rgb(positive(pixel[0]), positive(pixel[1]), positive(pixel[2]));
}

EnvironmentMap::Draw EnvironmentMap::sample(const V2f& u) const {
  const GuidedDraw row = draw_guided(row_cdf_, row_guide_, u.y);
  const size_t width = image_.width;
  const GuidedDraw column =
      draw_guided({&column_cdf_[row.index * width], width},
                  {&column_guide_[row.index * column_guide_size_], column_guide_size_}, u.x);
  const double top = row_cosine_[row.index], bottom = row_cosine_[row.index + 1];
  const double cosine = top + row.rest * (bottom - top);
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  const double turn = (static_cast<double>(column.index) + column.rest) / static_cast<double>(width) - 0.5;
  const double phi = 2 * kPiD * turn;
  return {V3f(static_cast<float>(sine * std::sin(phi)), static_cast<float>(cosine),
              static_cast<float>(-sine * std::cos(phi))),
          {static_cast<int>(column.index), static_cast<int>(row.index)}};
}

EnvironmentMap::Texel EnvironmentMap::texel_of(const V3f& direction) const {
  const float turn = std::atan2(direction.x, -direction.z) / (2.0f * kPi) + 0.5f;
  const float sine = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  const float polar = std::atan2(sine, direction.y) / kPi;
  const auto cell = [](float place, int count) {
    return std::clamp(static_cast<int>(place * static_cast<float>(count)), 0, count - 1);
  };
  return {cell(turn, image_.width), cell(polar, image_.height)};
}

}  // namespace pelage
