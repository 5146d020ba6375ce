// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_beam.h"

#include <cmath>

namespace pelage {
namespace {

constexpr float kBeamRounding = 0x1p-18f;

}  // namespace

/// The least position of many lines is a concave function of depth: between two depths it is above its chord.
TileBeam::TileBeam(const TileFrame& frame, const TileLines& lines, float near, float first, float last) {
  last = std::max(last, first + 1e-3f * std::abs(first) + 1e-20f);
  const std::array<Range, 2> begin = lines.extent(first), end = lines.extent(last);
  const float reach = std::max({std::abs(first), std::abs(last), frame.origin.length()});
  for (size_t i = 0; i < 4; ++i) {
    const size_t axis = i / 2;
    const bool is_low = i % 2 == 0;
    const float sign = is_low ? 1.0f : -1.0f;
    const float from = is_low ? begin[axis].low : begin[axis].high,
                to = is_low ? end[axis].low : end[axis].high;
    Side& side = sides_[i];
    side.axis = static_cast<int>(axis);
    side.sign = sign;
    side.slope = (to - from) / (last - first);
    side.offset = from - side.slope * first - sign * kBeamRounding * (reach + std::abs(from) + std::abs(to));
    const V3f normal = sign * (frame.axes[axis] - side.slope * frame.axes[2]);
    beam_.sides[i] = {normal, -sign * side.offset - normal.dot(frame.origin)};
  }
  for (size_t axis = 0; axis < 2; ++axis)
    beam_.across[axis] = {frame.axes[axis], -frame.axes[axis].dot(frame.origin)};
  beam_.depth = {frame.axes[2], -frame.axes[2].dot(frame.origin)};
  beam_.near = near - kBeamRounding * reach;
}

}  // namespace pelage
