// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/raster/tile_raster_test.cpp.
#include "render/raster/tile_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {
namespace {

constexpr int kChangesPerUpdate = 64;
constexpr float kRounding = 1e-5f;
constexpr float kNear = 4;  // times the reach of a piece

}  // namespace

/// The opacity of one segment.
class TileDrawing::Opacity final : public RasterFilter {
 public:
  Opacity(const ChunkGeometry& geometry, uint32_t segment) : geometry_(geometry), segment_(segment) {}
  bool stops(uint32_t random, float u) const override { return geometry_.stops(random, segment_, u); }

 private:
  const ChunkGeometry& geometry_;
  uint32_t segment_;
};

TileDrawing::TileDrawing(const TileFrame& frame, const Range& starts, TileLines& lines)
    : frame_(frame),
      starts_(starts),
      lines_(lines),
      runs_(lines, starts.high),
      far_(std::numeric_limits<float>::infinity()) {
  target_.lines = lines.arrays();
  target_.has_lens = lines.has_lens();
  target_.near = starts.high;
  // The kernels measure distances perpendicular to the frame's axis; rays measure them perpendicular to the
  // ray.
  const std::array<Range, 2> from = lines.extent(0), to = lines.extent(1);
  float slope2 = 0;
  for (size_t axis = 0; axis < 2; ++axis) {
    const float slope =
        std::max(std::abs(to[axis].low - from[axis].high), std::abs(to[axis].high - from[axis].low));
    slope2 += slope * slope;
  }
  wider_ = std::sqrt(1 + slope2) - 1;
}

bool TileDrawing::draw(const ChunkGeometry& geometry, uint32_t chunk, const Range& depths) {
  const TileBeam region = beam(depths);
  geometry_ = &geometry;
  beam_ = &region;
  target_.chunk = chunk;
  possible_ = true;
  const bool visited = geometry.visit_primitives(region.beam(), *this);
  beam_ = nullptr;
  geometry_ = nullptr;
  return visited && possible_;
}

void TileDrawing::update_far() {
  if (changes_ == 0) return;
  changes_ = 0;
  far_ = lines_.max_depth() * (1 + kRounding);
}

KeySpan TileDrawing::key_span(size_t key, size_t keys) {
  return {static_cast<float>(keys - 1), static_cast<float>(key), key + 2 >= keys};
}

/// Whether a piece is far enough from where lines start: there, directions across the axis of the tile are
/// not those across the ray.
bool TileDrawing::is_possible(const RasterPiece& piece) const {
  for (const float f : {0.0f, 1.0f}) {
    const V3f ends[2] = {piece.at.p + f * piece.motion.p, piece.at.end() + f * piece.motion.end()};
    const float reach = std::max(piece.r, piece.r + piece.dr) + (piece.at.q + f * piece.motion.q).length();
    const float min_depth = std::min(ends[0].z, ends[1].z);
    if (min_depth <= starts_.high + kNear * reach && !beam_->misses(ends, reach)) return false;
    if (!piece.moves) break;
  }
  return true;
}

template <class Shape>
void TileDrawing::draw_shape(const Shape& shape, const KeySpan& keys) {
  runs_.find(shape, keys);
  if (pelage::draw(target_, runs_.runs(), shape, keys) && ++changes_ >= kChangesPerUpdate) update_far();
}

void TileDrawing::begin_segments(const SegmentGrid& grid) {
  grid_ = GridToTile(frame_, grid.anchor, grid.step);
  segments_.resize(static_cast<size_t>(grid.motion_keys));
}

void TileDrawing::segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) {
  Four largest[4], low = four(std::numeric_limits<float>::infinity()), high = -low, radius = four(0);
  std::fill_n(largest, 4, high);
  for (size_t key = 0; key < keys.size(); ++key) {
    FourSegments& here = segments_[key];
    for (size_t i = 0; i < 4; ++i) {
      here.p[i] = grid_(keys[key].p[i]);
      here.r[i] = four(grid_.step()) * keys[key].r[i];
      beam_->add_insides(here.p[i], largest);
      radius = larger(radius, here.r[i]);
      low = smaller(low, here.p[i].z);
      high = larger(high, here.p[i].z);
    }
  }
  const Four inside = smaller(smaller(largest[0], largest[1]), smaller(largest[2], largest[3])) + radius;
  for (size_t lane = 0; lane < 4; ++lane) {
    if (numbers[lane] == kNone || !(inside[lane] >= 0) ||
        is_hidden({low[lane] - radius[lane], high[lane] + radius[lane]}))
      continue;
    draw_segment(numbers[lane], lane);
  }
}

void TileDrawing::draw_segment(uint32_t number, size_t lane) {
  const Opacity opacity(*geometry_, number);
  target_.filter = geometry_->opaque() ? nullptr : &opacity;
  target_.primitive = number;
  const size_t count = segments_.size();
  const auto at_key = [&](size_t key) {
    TileSegment segment;
    const FourSegments& all = segments_[key];
    for (size_t i = 0; i < 4; ++i) {
      segment.p[i] = V3f(all.p[i].x[lane], all.p[i].y[lane], all.p[i].z[lane]);
      segment.r[i] = all.r[i][lane];
    }
    return segment;
  };
  TileSegment from = at_key(0), to;
  for (size_t key = 0; key + 1 < std::max<size_t>(count, 2); ++key) {
    if (count > 1) to = at_key(key + 1);
    for (const RasterPiece& piece : FlatPieces(from, count > 1 ? to : from, wider_)) {
      possible_ = possible_ && is_possible(piece);
      draw_shape(piece, key_span(key, count));
    }
    from = to;
  }
  target_.filter = nullptr;
}

void TileDrawing::triangle(uint32_t /*number*/, std::span<const V3f> corners) {
  const size_t count = corners.size() / 3;
  corners_.resize(corners.size());
  Range depths;
  for (size_t i = 0; i < corners.size(); ++i) {
    corners_[i] = frame_.local(corners[i]);
    depths.extend(corners_[i].z);
  }
  if (count == 1 && beam_->misses(corners_, 0)) return;
  if (is_hidden(depths)) return;
  if (depths.low <= starts_.high && starts_.size() > 0) possible_ = false;
  target_.primitive = 0;  // the ray finds the triangle itself
  for (size_t key = 0; key + 1 < std::max<size_t>(count, 2); ++key) {
    RasterTriangle triangle;
    triangle.moves = count > 1;
    for (size_t i = 0; i < 3; ++i) {
      triangle.corners[i] = corners_[3 * key + i];
      if (triangle.moves) triangle.motion[i] = corners_[3 * (key + 1) + i] - triangle.corners[i];
    }
    draw_shape(triangle, key_span(key, count));
  }
}

}  // namespace pelage
