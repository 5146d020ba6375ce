// SPDX-License-Identifier: Apache-2.0
#include "render/raster/line_runs.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

constexpr float kLineRounding = 1.0001f;
/// Shapes nearer than this many times their reach may be met by any line.
constexpr float kNearPart = 1e-3f;

}  // namespace

Range key_fractions(const TileLines::Group& group, const KeySpan& keys) {
  const Range f{group.time.low * keys.scale - keys.first, group.time.high * keys.scale - keys.first};
  if (!(f.high >= 0 && f.low <= 1)) return {};
  return {std::max(f.low, 0.0f), std::min(f.high, 1.0f)};
}

/// Lines may be anywhere where a shape is beside the origin or behind.
bool LineRuns::all_if_near(float min_depth, float reach) {
  if (min_depth > std::max(near_, 0.0f) + kNearPart * reach) return false;
  runs_[0] = {0, static_cast<uint32_t>(lines_.size())};
  count_ = 1;
  return true;
}

/// Adds a run; joins the last two where there is no room left.
void LineRuns::add(const TileLines::Run& run) {
  if (run.begin >= run.end) return;
  if (count_ > 0 && (count_ == runs_.size() || runs_[count_ - 1].end == run.begin)) {
    runs_[count_ - 1].end = std::max(runs_[count_ - 1].end, run.end);
    return;
  }
  runs_[count_++] = run;
}

/// A line with its a in the middle of the group passes through `p` at this position; others pass beside it.
LineRuns::Point LineRuns::project(const TileLines::Group& group, const V3f& p, float reach,
                                  float min_depth) const {
  const float inverse = 1 / std::max(p.z, min_depth), shift = inverse - lines_.inverse_reference();
  Point result{{p.x * inverse, p.y * inverse}, kLineRounding * reach / min_depth};
  if (lines_.has_lens()) {
    const V2f middle(0.5f * (group.a[0].low + group.a[0].high), 0.5f * (group.a[1].low + group.a[1].high));
    const V2f half(0.5f * group.a[0].size(), 0.5f * group.a[1].size());
    result.at -= shift * middle;
    // The depth of the meeting point differs by less than `reach`.
    const float farther = reach / min_depth * inverse;
    result.width += kLineRounding * std::max(half.x, half.y) * (std::abs(shift) + farther) +
                    farther * std::max(std::abs(middle.x), std::abs(middle.y));
  }
  result.width += 1e-6f * (std::abs(result.at.x) + std::abs(result.at.y));
  return result;
}

void LineRuns::add_box(const TileLines::Group& group, const Box& box) {
  const TileLines::Rows rows = lines_.rows(box.y);
  for (int row = rows.first; row <= rows.last; ++row) add(lines_.run(group, row, box.x));
}

/// Adds the lines within a width of the chord between two points.
void LineRuns::add_capsule(const TileLines::Group& group, const Point& from, const Point& to) {
  const float width = std::max(from.width, to.width);
  Range x, y;
  x.extend(from.at.x), x.extend(to.at.x);
  y.extend(from.at.y), y.extend(to.at.y);
  const TileLines::Rows rows = lines_.rows(y.widened(width));
  const V2f chord = to.at - from.at;
  const float slope = chord.y != 0 ? chord.x / chord.y : 0;
  for (int row = rows.first; row <= rows.last; ++row) {
    Range part = x;
    if (slope != 0) {
      const Range high = lines_.row_range(row).widened(width + 1e-5f * width);
      const float a = from.at.x + (std::max(high.low, y.low) - from.at.y) * slope;
      const float b = from.at.x + (std::min(high.high, y.high) - from.at.y) * slope;
      part = {std::max(std::min(a, b), x.low), std::min(std::max(a, b), x.high)};
      const float rounding = 1e-5f * (x.size() + width);
      part = part.widened(rounding);
    }
    add(lines_.run(group, row, part.widened(width)));
  }
}

void LineRuns::find(const RasterPiece& piece, const KeySpan& keys) {
  count_ = 0;
  const V3f from = piece.at.p, to = piece.at.end();
  const V3f motion_from = piece.motion.p, motion_to = piece.motion.end();
  const float bulge = std::max(piece.at.bulge(), piece.moves ? piece.after().bulge() : 0);
  const float reach = std::max(piece.r, piece.r + piece.dr) + 1.5f * bulge;
  float min_depth = std::min(from.z, to.z);
  if (piece.moves) min_depth = std::min({min_depth, from.z + motion_from.z, to.z + motion_to.z});
  min_depth -= bulge;
  if (all_if_near(min_depth, reach)) return;
  for (const TileLines::Group& group : lines_.groups()) {
    if (group.time.is_empty()) continue;
    if (!piece.moves) {
      add_capsule(group, project(group, from, reach, min_depth), project(group, to, reach, min_depth));
      continue;
    }
    const Range times = key_fractions(group, keys);
    if (times.is_empty()) continue;
    // An end moves along a straight line in the picture, between its positions at the first and last time.
    const auto path = [&](const V3f& at, const V3f& motion) {
      const Point first = project(group, at + times.low * motion, reach, min_depth);
      const Point last = project(group, at + times.high * motion, reach, min_depth);
      return Point{0.5f * (first.at + last.at),
                   std::max(first.width, last.width) + 0.5f * kLineRounding * (last.at - first.at).length()};
    };
    add_capsule(group, path(from, motion_from), path(to, motion_to));
  }
}

void LineRuns::find(const RasterTriangle& triangle, const KeySpan& keys) {
  count_ = 0;
  float min_depth = std::min({triangle.corners[0].z, triangle.corners[1].z, triangle.corners[2].z});
  for (size_t i = 0; triangle.moves && i < 3; ++i)
    min_depth = std::min(min_depth, triangle.corners[i].z + triangle.motion[i].z);
  const float reach = (triangle.corners[1] - triangle.corners[0]).length();
  if (all_if_near(min_depth, reach)) return;
  for (const TileLines::Group& group : lines_.groups()) {
    if (group.time.is_empty()) continue;
    Box box;
    if (!triangle.moves) {
      for (const V3f& p : triangle.corners) box.add(project(group, p, 0, min_depth));
      add_box(group, box);
      continue;
    }
    const Range times = key_fractions(group, keys);
    if (times.is_empty()) continue;
    for (const float f : {times.low, times.high}) {
      for (size_t i = 0; i < 3; ++i)
        box.add(project(group, triangle.corners[i] + f * triangle.motion[i], 0, min_depth));
    }
    add_box(group, box);
  }
}

}  // namespace pelage
