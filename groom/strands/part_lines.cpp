// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/part_lines.h"

#include <algorithm>
#include <cmath>

#include "base/job.h"
#include "geom/limit_surface.h"
#include "groom/strands/root_grid.h"
#include "groom/strands/rotation.h"
#include "groom/strands/skin_binding.h"

namespace pelage {
namespace {

/// Squared distance from a point to a box.
float distance2(const Box3f& box, const V3f& point) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float out = std::max({box.min[axis] - point[axis], point[axis] - box.max[axis], 0.0f});
    sum += out * out;
  }
  return sum;
}

}  // namespace

PartLines::PartLines(std::span<const std::vector<V3f>> lines, const LimitSurface& rest,
                     const SkinBinding& binding, const Job& job) {
  constexpr float kStep = 0.01f, kSamePlace = 1e-5f;  // of the skin's size
  const float size = rest.control_bounds().size().length();
  std::vector<V3f> points, normals;
  const auto add = [&](const V3f& point, bool given) {
    const RootAddress root = binding.nearest(point);
    points.push_back(rest.evaluate(root.face, root.u, root.v).position);
    normals.push_back(rest.frame(root.face, root.u, root.v).normal);
    if (given) off_skin_ = std::max(off_skin_, (points.back() - point).length());
  };
  for (const std::vector<V3f>& line : lines) {
    job.check_stop();
    points.clear();
    normals.clear();
    for (size_t i = 0; i < line.size(); ++i) {
      if (i > 0) {
        const V3f step = line[i] - line[i - 1];
        const int count = static_cast<int>(std::min(step.length() / (kStep * size), 200.0f)) + 1;
        for (int k = 1; k < count; ++k)
          add(line[i - 1] + step * (static_cast<float>(k) / static_cast<float>(count)), false);
      }
      add(line[i], true);
    }
    add_line(points, normals, kSamePlace * size);
    // Too many segments: stop here. The caller compares segment_count() with the limit and refuses.
    if (segments_.size() > kMaxSegments) return;
  }
}

void PartLines::add_line(const std::vector<V3f>& points, const std::vector<V3f>& normals, float smallest) {
  Line line{segments_.size(), 0, {}};
  for (size_t i = 0, last = 0; i < points.size(); ++i) {
    line.box.extendBy(points[i]);
    const V3f step = points[i] - points[last];
    if (step.length() <= smallest) continue;
    Segment segment{};
    segment.from = points[last];
    segment.length = step.length();
    segment.along = step * (1.0f / segment.length);
    const V3f normal = normals[last] + normals[i];
    const V3f upright = normal - segment.along * segment.along.dot(normal);
    segment.normal = normalised_or(upright, any_perpendicular(segment.along));
    segment.side = segment.along.cross(segment.normal);
    segments_.push_back(segment);
    last = i;
  }
  line.end = segments_.size();
  if (line.begin == line.end) return;
  const bool closed = line.end - line.begin > 2 && (points.front() - points.back()).length() <= smallest;
  segments_[line.begin].starts_line = !closed;
  segments_.back().ends_line = !closed;
  lines_.push_back(line);
}

bool PartLines::divides(const V3f& a, const V3f& normal, const V3f& b) const {
  constexpr float kOverlap = 0.02f;  // of a segment's length: no gaps at bends of the line or the skin
  const V3f step = b - a;
  const float reach2 = step.dot(step);
  for (const Line& line : lines_) {
    if (distance2(line.box, a) > reach2) continue;
    for (size_t i = line.begin; i < line.end; ++i) {
      const Segment& segment = segments_[i];
      const V3f from_line = a - segment.from;
      const float here = from_line.dot(segment.side), there = here + step.dot(segment.side);
      if ((here >= 0) == (there >= 0)) continue;
      const V3f crossing = from_line + step * (here / (here - there));
      const float at = crossing.dot(segment.along), room = kOverlap * segment.length;
      if (at < -room || at > segment.length + room) continue;
      const float height = crossing.dot(segment.normal);
      if (height * height <= reach2 && RootGrid::same_side(segment.normal, normal)) return true;
    }
  }
  return false;
}

bool PartLines::nearest(const V3f& root, const V3f& normal, float limit, Nearest& result) const {
  float best2 = limit * limit;
  const Segment* found = nullptr;
  for (const Line& line : lines_) {
    if (distance2(line.box, root) > best2) continue;
    for (size_t i = line.begin; i < line.end; ++i) {
      const Segment& segment = segments_[i];
      const V3f from = root - segment.from;
      const float at = std::clamp(from.dot(segment.along), 0.0f, segment.length);
      const V3f way = from - segment.along * at;
      const float d2 = way.dot(way);
      if (d2 > best2 || (found && d2 == best2) || !RootGrid::same_side(segment.normal, normal)) continue;
      best2 = d2;
      found = &segment;
    }
  }
  if (!found) return false;
  const V3f from = root - found->from;
  const float at = from.dot(found->along), clamped = std::clamp(at, 0.0f, found->length);
  const float across = from.dot(found->side);
  const V3f side = across < 0 ? -found->side : found->side;
  const V3f way = from - found->along * clamped;
  result.distance = std::sqrt(best2);
  result.beside = 1;
  result.away = way.length() > 1e-4f * found->length ? normalised_or(way, side) : side;
  if ((found->starts_line && at < 0) || (found->ends_line && at > found->length)) {
    const float beyond = at - clamped;
    result.beside = across * across / (across * across + beyond * beyond);
    result.away = side;
  }
  return true;
}

}  // namespace pelage
