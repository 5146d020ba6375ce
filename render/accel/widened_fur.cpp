// SPDX-License-Identifier: Apache-2.0
#include "render/accel/widened_fur.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geom/root_detail.h"
#include "render/accel/fur/fur_beam.h"

namespace pelage {
namespace {

/// Upper bound of the distance of a point in a beam from the camera, divided by its depth, times the length
/// of the normals of the beam's sides.
constexpr float kFarther = 2;

float bernstein(const std::array<float, 4>& r, float u) {
  const float s = 1 - u;
  return s * s * s * r[0] + 3 * s * s * u * r[1] + 3 * s * u * u * r[2] + u * u * u * r[3];
}

Four size_of(Four x) { return larger(x, -x); }

/// The beam with its sides moved outwards by the min radius.
Beam widened(const Beam& beam, const MinWidth& min) {
  Beam result = beam;
  const float outward = kFarther * min.radius_at(1.0f);
  for (BeamPlane& side : result.sides) {
    side.normal += outward * beam.depth.normal;
    side.offset += outward * beam.depth.offset;
  }
  return result;
}

}  // namespace

/// Passes on segments with widened radii.
class WidenedFur::Sink final : public PrimitiveSink {
 public:
  Sink(const WidenedFur& fur, const FurTreeView& tree, const PackedStrands& strands, PrimitiveSink& to)
      : fur_(fur), tree_(tree), strands_(strands), to_(to) {}

  float far() const override { return to_.far(); }
  bool hides(const ViewFootprint& footprint) const override { return to_.hides(footprint); }
  void find_footprints(const FourViewBoxes& boxes, ViewFootprint (&footprints)[4]) const override {
    FourViewBoxes wider = boxes;
    const auto reach = [](Four low, Four high) { return larger(size_of(low), size_of(high)); };
    const Four distance = reach(boxes.low.x, boxes.high.x) + reach(boxes.low.y, boxes.high.y) +
                          reach(boxes.low.z, boxes.high.z);
    const Four margin = distance * four(fur_.min_.radius_at(1.0f));
    wider.low.x -= margin;
    wider.low.y -= margin;
    wider.high.x += margin;
    wider.high.y += margin;
    to_.find_footprints(wider, footprints);
  }
  void begin_segments(const SegmentGrid& grid) override { to_.begin_segments(grid); }
  void segments(const uint32_t (&numbers)[4], std::span<const FourSegments> keys) override {
    keys_.assign(keys.begin(), keys.end());
    for (size_t lane = 0; lane < 4; ++lane) {
      if (numbers[lane] == kNone) continue;
      const FourVectors& at = keys[0].p[0];
      const float min =
          fur_.min_radius(tree_, {at.x[lane], at.y[lane], at.z[lane]}, strands_.locate(numbers[lane]).strand);
      for (FourSegments& key : keys_) {
        for (Four& r : key.r) r[lane] = std::max(r[lane], min);
      }
    }
    to_.segments(numbers, keys_);
  }
  void triangle(uint32_t number, std::span<const V3f> corners) override { to_.triangle(number, corners); }

 private:
  const WidenedFur& fur_;
  const FurTreeView& tree_;
  const PackedStrands& strands_;
  PrimitiveSink& to_;
  std::vector<FourSegments> keys_;
};

WidenedFur::WidenedFur(const MinWidth& min, const PackedStrands& strands) : min_(min) {
  StrandArrays memory;
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    Strands strand(strands.bezier_strand(static_cast<uint32_t>(s), std::move(memory)));
    const std::optional<RootDetail> detail = RootDetail::of(strand, 0);
    if (!detail) return;  // no strand has any
    if (widened_before_.empty()) widened_before_.resize(strands.strand_count());
    widened_before_[s] = detail->share() < 1;
    memory = std::move(strand).release();
  }
}

void WidenedFur::visit(const FurTreeView& tree, const PackedStrands& strands, const Beam& beam,
                       PrimitiveSink& sink) const {
  Sink wider(*this, tree, strands, sink);
  visit_segments(tree, widened(beam, min_), wider);
}

float WidenedFur::min_radius(const FurTreeView& tree, const V3f& first, uint32_t strand) const {
  if (!widened_before_.empty() && widened_before_[strand]) return 0;
  return min_.radius_at(tree.anchor + tree.step * first) / tree.step;
}

WidenedFur::Segment WidenedFur::segment(const FurTreeView& tree, const std::byte* block, bool wide,
                                        size_t lane, uint32_t strand) const {
  Segment result;
  for (int key = 0; key < tree.motion_keys; ++key) result.keys.push_back(read_block(block, wide, lane, key));
  const auto& first = result.keys[0][0];
  result.min_radius = min_radius(tree, {first[0], first[1], first[2]}, strand);
  return result;
}

float WidenedFur::Segment::share(float u) const {
  std::array<float, 4> own, wider;
  for (size_t i = 0; i < 4; ++i) {
    own[i] = keys[0][i][3];
    wider[i] = std::max(own[i], min_radius);
  }
  const float radius = bernstein(wider, u);
  return radius > 0 ? bernstein(own, u) / radius : 1;
}

const std::byte* WidenedFur::Segment::write(uint32_t number, std::vector<Four>& memory) const {
  std::vector<SnappedSegment> wider = keys;
  for (SnappedSegment& key : wider) {
    for (auto& point : key) point[3] = std::max(point[3], min_radius);
  }
  FurBlockContents contents;
  contents.numbers[0] = number;
  contents.segments = wider;
  const auto count = static_cast<int>(keys.size());
  memory.resize(kWideBlock.block(count) / sizeof(Four) + 1);
  auto* out = reinterpret_cast<std::byte*>(memory.data());
  write_block(contents, count, true, out);
  return out;
}

}  // namespace pelage
