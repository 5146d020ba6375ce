// SPDX-License-Identifier: Apache-2.0
#include "render/film/film_sums.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

int tiles_along(int pixels) { return (pixels + FilmSums::kTileSide - 1) / FilmSums::kTileSide; }

/// Max distance, in pixels, from a sample's own pixel to another pixel that it counts for.
int reach_of(std::optional<PixelFilter> splat) {
  return splat ? static_cast<int>(std::ceil(filter_radius(*splat) - 0.5f)) : 0;
}

}  // namespace

FilmSums::FilmSums(int width, int height, size_t channels, std::optional<PixelFilter> splat)
    : width_(width),
      height_(height),
      columns_(tiles_along(width)),
      rows_(tiles_along(height)),
      reach_(reach_of(splat)),
      buffer_side_(kTileSide + 2 * reach_),
      stride_(channels + 1),
      splat_(splat),
      sums_(bytes_needed(width, height, channels, splat) / sizeof(float)) {}

size_t FilmSums::bytes_needed(int width, int height, size_t channels, std::optional<PixelFilter> splat) {
  const auto side = static_cast<size_t>(kTileSide + 2 * reach_of(splat));
  const auto tiles = static_cast<size_t>(tiles_along(width)) * static_cast<size_t>(tiles_along(height));
  return tiles * side * side * (channels + 1) * sizeof(float);
}

size_t FilmSums::tile_offset(int column, int row) const {
  const auto side = static_cast<size_t>(buffer_side_);
  return (static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)) * side *
         side * stride_;
}

FilmSums::Footprint FilmSums::footprint(const V2f& offset) const {
  Footprint result;
  if (!splat_) return result;
  const auto fill = [&](float from_centre, Footprint::Axis& axis) {
    axis.first = -reach_;
    axis.count = 2 * reach_ + 1;
    if (axis.count == 1) {
      axis.weights[0] = filter_value(*splat_, from_centre);
    } else {
      axis.weights = filter_around(*splat_, from_centre);
    }
  };
  fill(offset.x, result.across);
  fill(offset.y, result.down);
  return result;
}

/// Calls `use(floats of the pixel, weight)` for each pixel that a sample counts for.
template <class Use>
void FilmSums::for_each_pixel(int x, int y, const Footprint& footprint, const Use& use) {
  const Footprint::Axis &across = footprint.across, &down = footprint.down;
  const int column = x / kTileSide, row = y / kTileSide;
  const int left = x - column * kTileSide + reach_ + across.first;
  const int top = y - row * kTileSide + reach_ + down.first;
  float* buffer = &sums_[tile_offset(column, row)];
  for (int j = 0; j < down.count; ++j) {
    float* pixel = buffer + static_cast<size_t>((top + j) * buffer_side_ + left) * stride_;
    for (int i = 0; i < across.count; ++i, pixel += stride_) {
      use(pixel, across.weights[static_cast<size_t>(i)] * down.weights[static_cast<size_t>(j)]);
    }
  }
}

void FilmSums::add(int x, int y, const Footprint& footprint, std::span<const float> first,
                   std::span<const float> others) {
  for_each_pixel(x, y, footprint, [&](float* pixel, float weight) {
    for (size_t i = 0; i < first.size(); ++i) pixel[i] += weight * first[i];
    float* sum = pixel + first.size();
    for (size_t i = 0; i < others.size(); ++i) sum[i] += weight * others[i];
  });
}

void FilmSums::add_weight(int x, int y, const Footprint& footprint) {
  for_each_pixel(x, y, footprint, [&](float* pixel, float weight) { pixel[stride_ - 1] += weight; });
}

float FilmSums::mean(int x, int y, size_t channel, std::span<const uint32_t> samples) const {
  const int c0 = std::max(0, (x - reach_) / kTileSide), c1 = std::min(columns_ - 1, (x + reach_) / kTileSide);
  const int r0 = std::max(0, (y - reach_) / kTileSide), r1 = std::min(rows_ - 1, (y + reach_) / kTileSide);
  // All pixels of a tile have the same count; in a region, those farther from (x, y) may have none.
  const auto samples_of = [&](int column, int row) {
    const int left = column * kTileSide, top = row * kTileSide;
    const int i = std::clamp(x, left, left + kTileSide - 1), j = std::clamp(y, top, top + kTileSide - 1);
    return samples[static_cast<size_t>(j) * static_cast<size_t>(width_) + static_cast<size_t>(i)];
  };
  bool equal = true;
  for (int row = r0; row <= r1; ++row) {
    for (int column = c0; column <= c1; ++column) equal &= samples_of(column, row) == samples_of(c0, r0);
  }
  float sum = 0, weight = 0;
  for (int row = r0; row <= r1; ++row) {
    for (int column = c0; column <= c1; ++column) {
      const uint32_t count = equal ? 1 : samples_of(column, row);
      if (count == 0) continue;
      const float share = 1.0f / static_cast<float>(count);
      const int left = x - column * kTileSide + reach_, top = y - row * kTileSide + reach_;
      const float* pixel =
          &sums_[tile_offset(column, row) + static_cast<size_t>(top * buffer_side_ + left) * stride_];
      sum += share * pixel[channel];
      weight += share * pixel[stride_ - 1];
    }
  }
  return weight > 0 ? sum / weight : 0.0f;
}

}  // namespace pelage
