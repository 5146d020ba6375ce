// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/push_out.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "base/value_readers.h"
#include "geom/closest_point.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

/// Max distance from the tip to the root, in lengths of the strand: pushing stretches it slightly.
constexpr float kReach = 1.02f;

/// One strand during push_out, in the space of the pose.
class PushedStrand {
 public:
  PushedStrand(const StrandBatch& batch, size_t s)
      : skin_(*batch.skin),
        root_(vector_at(batch.current.position, s)),
        normal_(vector_at(batch.current.normal, s)) {
    const int count = batch.point_count();
    float arc = 0;
    for (int p = 0; p < count; ++p) {
      points_.push_back(root_ + batch.offset(p, s));
      const float length = p > 0 ? (points_[index(p)] - points_[index(p - 1)]).length() : 0.0f;
      arc += length;
      lengths_.push_back(length);
      arcs_.push_back(arc);
    }
  }

  const std::vector<V3f>& points() const { return points_; }

  /// Lays out the strand again from the root, segment by segment: each keeps its length and, unless it leads
  /// into the skin, its direction; otherwise it slides along the skin.
  void slide(float offset, int rounds, const V3f& tangent) {
    const std::vector<V3f> before = points_;
    for (size_t p = 1; p < points_.size(); ++p) {
      const V3f& from = points_[p - 1];
      V3f direction = normalised_or(before[p] - before[p - 1], normal_);
      points_[p] = from + direction * lengths_[p];
      for (int round = 0; round < rounds; ++round) {
        V3f target = points_[p];
        V3f out;
        // `from` is outside, so no point of the segment is deeper than its length.
        if (!push(target, clearance(p, offset), lengths_[p] + offset, &out)) break;
        if (round == 0) {
          direction -= out * std::min(direction.dot(out), 0.0f);
          if (direction.dot(direction) < 0.01f) direction = tangent - out * tangent.dot(out);
        } else {
          direction = target - from;
        }
        points_[p] = from + normalised_or(direction, out) * lengths_[p];
      }
    }
  }

  /// Moves control points that are inside or nearer than their clearance.
  void push_points(float offset) {
    for (size_t p = 1; p < points_.size(); ++p)
      push(points_[p], clearance(p, offset), depth_limit(points_[p]) + offset);
  }

  /// Where the curve between control points is inside, moves the adjacent control points; returns whether any
  /// moved.
  bool push_curve() {
    bool moved = false;
    for (size_t segment = 0; segment + 1 < points_.size(); ++segment) {
      for (float t : {0.25f, 0.5f, 0.75f, 1.0f}) {
        const V3f on_curve = curve(segment, t);
        V3f out = on_curve;
        if (!push(out, 0.0f, depth_limit(out))) continue;
        moved = true;
        // The two nearest control points have two thirds or more of the weight here.
        const V3f step = (out - on_curve) * 1.6f;
        if (segment > 0) points_[segment] += step;
        points_[segment + 1] += step;
      }
    }
    return moved;
  }

  /// Last resort: keeps the part of the strand that is outside and within kReach of its length, stretched
  /// over all points.
  void draw_back() {
    size_t good = 0;
    while (good + 1 < points_.size() && is_outside(good)) ++good;
    if (good + 1 == points_.size()) return;
    std::vector<V3f> kept(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(good) + 1);
    const size_t last = points_.size() - 1;
    if (good == 0) {
      // Only the root is outside: a stub along its normal.
      for (size_t p = 1; p <= last; ++p) points_[p] = root_ + normal_ * (1e-3f * arcs_[p]);
      return;
    }
    for (size_t p = 1; p <= last; ++p) {
      const float at = static_cast<float>(p * good) / static_cast<float>(last);
      const size_t segment = std::min(static_cast<size_t>(at), good - 1);
      points_[p] = kept[segment] + (kept[segment + 1] - kept[segment]) * (at - static_cast<float>(segment));
    }
  }

 private:
  static size_t index(int p) { return static_cast<size_t>(p); }

  /// The root is on the skin, so points near it cannot keep the full distance.
  float clearance(size_t p, float offset) const { return std::min(offset, 0.5f * arcs_[p]); }

  /// The root is on the skin: no point is deeper than its distance from it.
  float depth_limit(const V3f& point) const { return (point - root_).length(); }

  /// Moves a point that is inside, or outside but nearer than `distance`, to that distance; returns whether
  /// it moved. `out_of` receives the outward direction. Searches up to `limit`.
  bool push(V3f& point, float distance, float limit, V3f* out_of = nullptr) const {
    ClosestPoint nearest;
    if (!skin_.closest(point, limit * 1.001f + 1e-6f, nearest)) return false;
    if (!nearest.inside && nearest.distance >= distance * 0.999f) return false;
    const V3f way = nearest.inside ? nearest.position - point : point - nearest.position;
    const V3f out = nearest.distance > 1e-6f * limit ? normalised_or(way, nearest.normal) : nearest.normal;
    // Slightly farther, so that rounding does not leave the point inside.
    point = nearest.position + out * (distance + 1e-4f * limit);
    if (out_of) *out_of = out;
    return true;
  }

  bool is_outside(size_t segment) const {
    const V3f& end = points_[segment + 1];
    if ((end - points_[0]).length() > arcs_.back() * kReach) return false;
    for (float t : {0.25f, 0.5f, 0.75f, 1.0f}) {
      ClosestPoint nearest;
      const V3f at = curve(segment, t);
      const float limit = (at - root_).length() * 1.001f + 1e-6f;
      if (skin_.closest(at, limit, nearest) && nearest.inside && nearest.distance > 1e-5f * limit)
        return false;
    }
    return true;
  }

  /// The pinned uniform B-spline of the control points.
  V3f curve(size_t segment, float t) const {
    const size_t last = points_.size() - 1;
    const V3f p1 = points_[segment], p2 = points_[segment + 1];
    const V3f p0 = segment > 0 ? points_[segment - 1] : p1 * 2.0f - p2;
    const V3f p3 = segment + 2 <= last ? points_[segment + 2] : p2 * 2.0f - p1;
    const float s = 1 - t;
    return (p0 * (s * s * s) + p1 * (3 * t * t * t - 6 * t * t + 4) + p2 * (3 * s * s * s - 6 * s * s + 4) +
            p3 * (t * t * t)) *
           (1.0f / 6);
  }

  const ClosestPointTree& skin_;
  V3f root_;
  V3f normal_;
  std::vector<V3f> points_;
  std::vector<float> lengths_;  // of the segment that ends at each point
  std::vector<float> arcs_;
};

}  // namespace

const Schema<PushOutParams>& PushOutParams::schema() {
  static const Schema<PushOutParams> table = [] {
    Schema<PushOutParams> s("push_out", "Pushes strands out of the posed skin. Runs in every pose.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - comb: {direction: [1, 0, 0], lift: 0.1}
      - bend: {direction: [0, -1, 0], angle: 120}
      - push_out: {offset: 0.02})");
    s.set_picture("Left: strands bent into the skin. Right: the same strands pushed out of it.");
    s.key("offset", &PushOutParams::offset,
          {.unit = "scene units",
           .help = "Minimum distance between strands and skin, except near the roots",
           .min = 0});
    s.key("iterations", &PushOutParams::iterations,
          {.help = "Maximum number of passes", .min = 1, .max = 64});
    return s;
  }();
  return table;
}

void PushOut::prepare(const PrepareContext& context) {
  params_.offset = params_.offset.with_textures(context.textures);
}

void PushOut::apply(StrandBatch& batch) const {
  PELAGE_CHECK(batch.skin != nullptr);
  StrandRow offset;
  evaluate(params_.offset, batch, 0, offset);
  for (size_t s = 0; s < batch.count; ++s) {
    const float distance = std::max(offset[s], 0.0f) * batch.scale;
    PushedStrand strand(batch, s);
    strand.slide(distance, params_.iterations, vector_at(batch.current.tangent, s));
    strand.push_points(distance);
    for (int i = 0; i < params_.iterations && strand.push_curve(); ++i) {
    }
    strand.draw_back();
    const V3f root = vector_at(batch.current.position, s);
    for (int p = 1; p < batch.point_count(); ++p) {
      batch.set_offset(p, s, strand.points()[static_cast<size_t>(p)] - root);
    }
  }
}

StrandReach PushOut::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  after.distance = std::max(before.distance, before.length * kReach);
  after.length = 2.0f * before.length * static_cast<float>(before.segments);
  after.lean = std::numbers::pi_v<float>;
  return after;
}

}  // namespace pelage
