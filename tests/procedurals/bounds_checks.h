// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/progress.h"
#include "geom/curve_bounds.h"
#include "procedurals/bounds/bounding.h"

namespace pelage {

inline constexpr BoundingStrategy kHolding[] = {BoundingStrategy::kConservative, BoundingStrategy::kExact,
                                                BoundingStrategy::kExactShutter, BoundingStrategy::kLinear};

class WarningReceiver final : public Progress {
 public:
  explicit WarningReceiver(WarningSink receive) : receive_(std::move(receive)) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { receive_(std::string(line)); }
  bool cancelled() const override { return false; }

 private:
  WarningSink receive_;
};

inline void expect_no_warning(const std::string& line) { ADD_FAILURE() << line; }

inline std::vector<ChunkBounds> bounds_of(const std::vector<const Procedural*>& chunks,
                                          const BoundingOptions& options, int threads = 2,
                                          const WarningSink& warn = expect_no_warning,
                                          BoundingCounts* counts = nullptr) {
  MemoryLedger ledger;
  const Workers workers(threads);
  WarningReceiver progress(warn);
  const std::vector<ChunkBounds> bounds = bound_chunks(options, chunks, {workers, ledger, progress}, counts);
  EXPECT_EQ(ledger.budgeted(), 0);
  EXPECT_EQ(bounds.size(), chunks.size());
  return bounds;
}

inline Box3f at_time(const ChunkBounds& bounds, size_t part, float time) {
  if (bounds.keys == 1) return bounds.box(part, 0);
  const Box3f &a = bounds.box(part, 0), &b = bounds.box(part, 1);
  return {(1 - time) * a.min + time * b.min, (1 - time) * a.max + time * b.max};
}

inline bool contains(const Box3f& outer, const Box3f& inner) {
  return inner.isEmpty() || (outer.intersects(inner.min) && outer.intersects(inner.max));
}

inline Box3f grown(const Box3f& box, float by) { return {box.min - V3f(by), box.max + V3f(by)}; }

inline float surface_area(const Box3f& box) {
  const V3f d = box.size();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

inline bool same(const SegmentCellBounds& a, const SegmentCellBounds& b) {
  if (a.count() != b.count() || a.levels() != b.levels()) return false;
  const SegmentCellBounds::Grid &x = a.grid(), &y = b.grid();
  if (x.corner != y.corner || x.motion != y.motion || x.step != y.step) return false;
  return a.count() == 0 || std::equal(a.level(0).begin(), a.level(0).end(), b.level(0).begin());
}

inline bool same(const std::vector<ChunkBounds>& a, const std::vector<ChunkBounds>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ChunkBounds& x, const ChunkBounds& y) {
    return x.keys == y.keys && x.boxes == y.boxes && same(x.cell_bounds, y.cell_bounds);
  });
}

/// Calls check(position, radius) for points on some segments of some strands at a time.
template <class Check>
inline void for_some_points(const Strands& strands, float time, size_t step, const Check& check) {
  for (size_t strand = 0; strand < strands.strand_count(); strand += step) {
    for (uint32_t s = 0; s < segment_count(strands.basis(), strands.strand_points(strand)); ++s) {
      const CubicSegment segment = bezier_segment_at(strands, strand, s, time);
      for (float t : {0.0f, 0.35f, 0.7f, 1.0f}) check(curve_position(segment, t), curve_radius(segment, t));
    }
  }
}

}  // namespace pelage
