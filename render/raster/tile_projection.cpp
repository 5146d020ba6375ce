// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_projection.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

using FourInts = int32_t __attribute__((vector_size(16)));

/// Hulls nearer than this may be beside or behind the point where lines start.
constexpr float kNearest = 1e-18f;
constexpr float kProjectionRounding = 2e-6f;  // of a position
constexpr float kCellMargin = 1e-3f;          // in cells

Four absolute(Four x) { return larger(x, -x); }
FourInts to_ints(Four x) { return __builtin_convertvector(x, FourInts); }

}  // namespace

TileProjection::TileProjection(const TileLines& lines, const Range& starts)
    : last_cell_(static_cast<float>(lines.grid().side() - 1)),
      a_{lines.offsets(0), lines.offsets(1)},
      inverse_reference_(lines.inverse_reference()),
      has_lens_(lines.has_lens()),
      first_depth_(std::min(starts.low, 0.0f)) {
  for (size_t axis = 0; axis < 2; ++axis) {
    low_[axis] = lines.grid().low(axis);
    inverse_size_[axis] = lines.grid().inverse_size(axis);
    // Lines that start at negative depths are a little farther outside there.
    const Range b = lines.slopes(axis);
    const float beyond = -first_depth_ * b.size();
    const float reach = std::abs(a_[axis].low) + std::abs(a_[axis].high);
    const float outward = beyond + kProjectionRounding * reach;
    sides_[2 * axis] = {axis, 1, a_[axis].low - outward, b.low};
    sides_[2 * axis + 1] = {axis, -1, a_[axis].high + outward, b.high};
  }
}

void TileProjection::Hulls::add(const FourVectors& p) {
  const Four inverse = four(1) / larger(p.z, four(kNearest));
  const Four along[2] = {p.x, p.y};
  for (size_t axis = 0; axis < 2; ++axis) {
    const Four at = along[axis] * inverse;
    low_[axis] = smaller(low_[axis], at);
    high_[axis] = larger(high_[axis], at);
  }
  near_ = smaller(near_, p.z);
  far_ = larger(far_, p.z);
  for (size_t i = 0; i < 4; ++i) {
    const Side& side = projection_.sides_[i];
    const Four inside = four(side.sign) * (along[side.axis] - four(side.offset) - four(side.slope) * p.z);
    insides_[i] = larger(insides_[i], inside);
  }
}

void TileProjection::Hulls::find(Four radius, Four nearer, ViewFootprint (&footprints)[4]) const {
  const TileProjection& tile = projection_;
  const Four first = near_ - nearer;
  const Four inverse = four(1) / larger(first, four(kNearest));
  // Shift of the position, from infinity to the reference depth, of lines with a = 1.
  const Four shift_far = four(1) / larger(far_, four(kNearest)) - four(tile.inverse_reference_);
  const Four shift_near = inverse - four(tile.inverse_reference_);
  const Four last_cell = four(tile.last_cell_);
  FourInts first_cells[2], last_cells[2], outside{}, near_inside = {-1, -1, -1, -1};
  for (size_t axis = 0; axis < 2; ++axis) {
    Four low = low_[axis], high = high_[axis];
    const Four wider = radius * inverse + four(kProjectionRounding) * (absolute(low) + absolute(high));
    low -= wider;
    high += wider;
    if (tile.has_lens_) {
      const Four a_low = four(tile.a_[axis].low), a_high = four(tile.a_[axis].high);
      const Four s[4] = {shift_far * a_low, shift_far * a_high, shift_near * a_low, shift_near * a_high};
      low -= larger(larger(s[0], s[1]), larger(s[2], s[3]));
      high -= smaller(smaller(s[0], s[1]), smaller(s[2], s[3]));
    }
    const Four origin = four(tile.low_[axis]), scale = four(tile.inverse_size_[axis]);
    const Four from = (low - origin) * scale - four(kCellMargin);
    const Four to = (high - origin) * scale + four(kCellMargin);
    outside |= (to < four(0)) | (from > last_cell + four(1));
    first_cells[axis] = to_ints(smaller(larger(from, four(0)), last_cell));
    last_cells[axis] = to_ints(smaller(larger(to, four(0)), last_cell));
    near_inside &= (insides_[2 * axis] + radius >= four(0)) & (insides_[2 * axis + 1] + radius >= four(0));
  }
  const Four depth = first - four(4 * kProjectionRounding) * absolute(first);
  const FourInts is_near = first <= four(kNearest);
  const FourInts is_behind = far_ + radius < four(tile.first_depth_);
  const auto last = static_cast<uint8_t>(tile.last_cell_);
  for (size_t lane = 0; lane < 4; ++lane) {
    ViewFootprint& f = footprints[lane];
    f = {};
    f.depth = depth[lane];
    if (is_near[lane]) {
      if (near_inside[lane] && !is_behind[lane]) f = {depth[lane], {0, 0}, {last, last}};
    } else if (!outside[lane]) {
      for (size_t axis = 0; axis < 2; ++axis) {
        f.first[axis] = static_cast<uint8_t>(first_cells[axis][lane]);
        f.last[axis] = static_cast<uint8_t>(last_cells[axis][lane]);
      }
    }
  }
}

void TileProjection::find(const FourViewBoxes& boxes, ViewFootprint (&footprints)[4]) const {
  // The axes are projected separately, so that pairs of corners suffice.
  Hulls hulls(*this);
  for (const Four z : {boxes.low.z, boxes.high.z}) {
    hulls.add({boxes.low.x, boxes.low.y, z});
    hulls.add({boxes.high.x, boxes.high.y, z});
  }
  hulls.find(four(0), four(0), footprints);
}

ViewFootprint TileProjection::find(std::span<const V3f> points) const {
  Hulls hulls(*this);
  for (const V3f& p : points) hulls.add({four(p.x), four(p.y), four(p.z)});
  ViewFootprint footprints[4];
  hulls.find(four(0), four(0), footprints);
  return footprints[0];
}

}  // namespace pelage
