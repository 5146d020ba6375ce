// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {
namespace {

/// Lines per primitive that is drawn before the grid of depths is updated.
constexpr int kLinesPerChange = 64, kMinChanges = 32;
constexpr float kNearReach = 4;     // times the reach of a piece
constexpr float kWiderBox = 1e-4f;  // of the size of a box

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
      projection_(lines, starts),
      runs_(lines, starts.high),
      changes_per_update_(std::max(kMinChanges, static_cast<int>(lines.size()) / kLinesPerChange)) {
  target_.lines = lines.arrays();
  target_.has_lens = lines.has_lens();
  target_.near = starts.low;
  target_.certain = starts.high;
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
  target_.chunk = chunk;
  passed_.clear();
  const bool visited = geometry.visit_primitives(region.beam(), *this);
  geometry_ = nullptr;
  return visited;
}

bool TileDrawing::may_see(const Box3f& box) const {
  if (box.isEmpty()) return false;
  const V3f half = 0.5f * box.size(), centre = frame_.local(box.center());
  if (!std::isfinite(half.x + half.y + half.z)) return true;
  FourViewBoxes boxes;
  Four* low[3] = {&boxes.low.x, &boxes.low.y, &boxes.low.z};
  Four* high[3] = {&boxes.high.x, &boxes.high.y, &boxes.high.z};
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<int>(axis);
    const float spread = (1 + kWiderBox) * BeamPlane{frame_.axes[axis], 0}.spread(half);
    *low[axis] = four(centre[a] - spread);
    *high[axis] = four(centre[a] + spread);
  }
  return may_see(boxes)[0];
}

std::array<bool, 4> TileDrawing::may_see(const FourViewBoxes& boxes) const {
  ViewFootprint footprints[4];
  projection_.find(boxes, footprints);
  std::array<bool, 4> result{};
  for (size_t lane = 0; lane < 4; ++lane)
    result[lane] = !footprints[lane].is_empty() && !hides(footprints[lane]);
  return result;
}

void TileDrawing::update() {
  if (changes_ == 0) return;
  changes_ = 0;
  lines_.update_grid();
}

KeySpan TileDrawing::key_span(size_t key, size_t keys) {
  return {static_cast<float>(keys - 1), static_cast<float>(key), key + 2 >= keys};
}

/// Whether a piece is far enough from where lines start: there, directions across the axis of the tile are
/// not those across the ray.
bool TileDrawing::is_possible(const RasterPiece& piece) const {
  for (const float f : {0.0f, 1.0f}) {
    const V3f ends[2] = {piece.at.p + f * piece.motion.p, piece.at.end() + f * piece.motion.end()};
    const float reach =
        std::max(piece.r, piece.r + piece.dr) + 4 * std::max(piece.at.bulge(), piece.after().bulge());
    const float min_depth = std::min(ends[0].z, ends[1].z);
    if (min_depth <= starts_.high + kNearReach * reach) return false;
    if (!piece.moves) break;
  }
  return true;
}

template <class Shape>
void TileDrawing::draw_shape(const Shape& shape, const KeySpan& keys) {
  runs_.find(shape, keys);
  if (pelage::draw(target_, runs_.runs(), shape, keys) && ++changes_ >= changes_per_update_) update();
}

void TileDrawing::begin_segments(const SegmentGrid& grid) {
  grid_ = GridToTile(frame_, grid.anchor, grid.step);
  segments_.resize(static_cast<size_t>(grid.motion_keys));
}

/// Whether a segment was passed before; long segments are in several leaves of a tree.
bool TileDrawing::was_passed(uint32_t number) {
  const size_t word = number / 64;
  const uint64_t bit = uint64_t{1} << number % 64;
  if (word >= passed_.size()) passed_.resize(word + 1, 0);
  const bool before = (passed_[word] & bit) != 0;
  passed_[word] |= bit;
  return before;
}

void TileDrawing::segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) {
  TileProjection::Hulls hulls(projection_);
  Four radius = four(0), error = four(0);
  for (size_t key = 0; key < keys.size(); ++key) {
    FourSegments& here = segments_[key];
    for (size_t i = 0; i < 4; ++i) {
      here.p[i] = grid_(keys[key].p[i]);
      here.r[i] = four(grid_.step()) * keys[key].r[i];
      hulls.add(here.p[i]);
      radius = larger(radius, here.r[i]);
    }
    error = larger(error, FlatPieces::max_error(here));
  }
  ViewFootprint footprints[4];
  hulls.find((radius + error) * four(1 + wider_), four(0), footprints);
  for (size_t lane = 0; lane < 4; ++lane) {
    if (numbers[lane] == kNone || footprints[lane].is_empty() || was_passed(numbers[lane]) ||
        hides(footprints[lane]))
      continue;
    draw_segment(numbers[lane], lane, footprints[lane]);
  }
}

void TileDrawing::draw_segment(uint32_t number, size_t lane, const ViewFootprint& footprint) {
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
  bool possible = true;
  for (size_t key = 0; key + 1 < std::max<size_t>(count, 2); ++key) {
    if (count > 1) to = at_key(key + 1);
    for (const RasterPiece& piece : FlatPieces(from, count > 1 ? to : from, wider_)) {
      possible = possible && is_possible(piece);
      draw_shape(piece, key_span(key, count));
    }
    from = to;
  }
  if (!possible) {
    lines_.trace(footprint);
    ++changes_;
  }
  target_.filter = nullptr;
}

void TileDrawing::triangle(uint32_t /*number*/, std::span<const V3f> corners) {
  const size_t count = corners.size() / 3;
  corners_.resize(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) corners_[i] = frame_.local(corners[i]);
  const ViewFootprint footprint = projection_.find(corners_);
  if (footprint.is_empty() || hides(footprint)) return;
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
