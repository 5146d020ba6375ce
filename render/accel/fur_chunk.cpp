// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur_chunk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/accel/fur/fur_beam.h"
#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_segment_rays.h"

namespace pelage {
namespace {

/// A crossing with a flat segment belongs to the nearer joint.
uint32_t joint_beside(float u) { return u > 0.5f ? 1 : 0; }

/// Upper bound of the size of grown contents.
size_t grown_bytes_bound(const ChunkCounts& n) {
  return 16 * static_cast<size_t>(n.motion_keys) * n.points +
         n.strands * (sizeof(uint32_t) + sizeof(uint64_t)) + n.strands * (sizeof(RootAddress) + sizeof(V2f)) +
         sizeof(float) * (n.points + n.attribute_floats);
}
size_t bytes_of(const FurContents& grown) {
  return grown.strands.bytes() + grown.opacity.capacity() * sizeof(float);
}

/// Prefetches a narrow block of a chunk at rest.
void fetch_ahead(const FurSegmentLookup::Place& place) {
  if (!place.block) return;
  for (size_t at = 0; at < kNarrowBlock.block(1); at += 64) __builtin_prefetch(place.block + at);
}

}  // namespace

/// Accepts the crossings at which a ray stops.
class FurChunk::StoppingFilter final : public FurFilter {
 public:
  /// `widened`: whether strands have the widths at which the camera sees them.
  StoppingFilter(const FurChunk& chunk, bool widened, uint32_t random)
      : chunk_(chunk), widened_(widened), random_(random) {}
  bool accepts(const FurHit& hit) override {
    return widened_ ? chunk_.stops(random_, hit.number, hit.u)
                    : chunk_.stops_unwidened(random_, hit.number, hit.u);
  }

 private:
  const FurChunk& chunk_;
  const bool widened_;
  const uint32_t random_;
};

/// Collects semi-transparent crossings; accepts opaque ones. If strands are counted, collects all crossings;
/// accepts the one that is too many.
class FurChunk::CollectingFilter final : public FurFilter {
 public:
  CollectingFilter(const FurChunk& chunk, Crossings& crossings) : chunk_(chunk), crossings_(crossings) {}
  bool accepts(const FurHit& hit) override {
    const PackedStrands::Place place = chunk_.strands_.locate(hit.number);
    const float opacity = chunk_.strands_.opaque() ? 1.0f : chunk_.strands_.opacity(place, hit.u);
    if (crossings_.counts()) return opacity > 0 && !crossings_.count(chunk_.crossing(place, hit.u), opacity);
    if (opacity >= 1) return true;
    if (opacity > 0) crossings_.add(chunk_.crossing(place, hit.u), opacity);
    return false;
  }

 private:
  const FurChunk& chunk_;
  Crossings& crossings_;
};

/// Accepts the crossings with the opaque parts of strands.
class FurChunk::ScreenDoorFilter final : public FurFilter {
 public:
  explicit ScreenDoorFilter(const FurChunk& chunk) : chunk_(chunk) {}
  bool accepts(const FurHit& hit) override {
    const PackedStrands::Place place = chunk_.strands_.locate(hit.number);
    return chunk_.door(place.strand).blocks(hit.h, chunk_.strands_.opacity(place, hit.u));
  }

 private:
  const FurChunk& chunk_;
};

FurChunk::FurChunk(ChunkContents contents, uint32_t number, const FurGrid& grid,
                   const FurChunkOptions& options)
    : FurChunk(FurContents(std::move(std::get<FurContents>(contents.geometry))), contents.part, number, grid,
               options) {}

FurChunk::FurChunk(const FurContents& grown, uint32_t part, uint32_t number, const FurGrid& grid,
                   const FurChunkOptions& options)
    : part_(part),
      number_(number),
      strands_(grown.strands, grown.opacity, options.compact_attributes),
      tree_(SnappedStrands(grown.strands, grid), options.tree),
      places_(tree_.view(), static_cast<uint32_t>(strands_.segment_count())),
      screen_door_(options.screen_door) {
  bytes_ = sizeof(*this) + strands_.bytes() - sizeof(strands_) + tree_.bytes() + places_.bytes();
  build_peak_ = sizeof(*this) + bytes_of(grown) + strands_.bytes() +
                SnappedStrands::bytes(grown.strands.strand_count()) +
                std::max(tree_.build_bytes(), tree_.bytes() + places_.bytes());
}

FurChunk::FurChunk(uint32_t part, uint32_t number, PackedStrands strands, FurTree tree)
    : part_(part),
      number_(number),
      strands_(std::move(strands)),
      tree_(std::move(tree)),
      places_(tree_.view(), static_cast<uint32_t>(strands_.segment_count())) {
  bytes_ = sizeof(*this) + strands_.bytes() - sizeof(strands_) + tree_.bytes() + places_.bytes();
  build_peak_ = bytes_;
}

void FurChunk::widen(const MinWidth& min) {
  widened_ = std::make_unique<const WidenedFur>(min, strands_);
  bytes_ += widened_->bytes();
  build_peak_ += widened_->bytes();
}

void FurChunk::unwiden() {
  if (!widened_) return;
  bytes_ -= widened_->bytes();
  build_peak_ -= widened_->bytes();
  widened_ = nullptr;
}

ChunkBounds FurChunk::part_bounds(size_t parts) const {
  ChunkBounds bounds = subtree_bounds(tree_.view(), parts);
  if (!tree_.view().frame.turned) return bounds;
  // Boxes around rotated ones extend beyond their contents.
  const FurTreeView& tree = tree_.view();
  for (Box3f& box : bounds.boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<size_t>(axis);
      const auto scene = [&](float grid) {
        return static_cast<float>(tree.anchor[axis] + static_cast<double>(grid) * tree.step);
      };
      box.min[axis] = std::max(box.min[axis], scene(tree_.box().low[a]));
      box.max[axis] = std::min(box.max[axis], scene(tree_.box().high[a]));
    }
  }
  return bounds;
}

FurStart FurChunk::start_of(const Ray& ray) const {
  if (ray.start.chunk != number_) return {};
  return {ray.start.first_segment, ray.start.segment_count, ray.start.place};
}

bool FurChunk::closest(const Ray& ray, FurRays& rays, NearestSoFar& nearest,
                       HitGeometry& hit_geometry) const {
  Ray here = ray;
  // A hit as near as the nearest so far may precede it.
  if (nearest.hit)
    here.far =
        std::min(ray.far, std::nextafter(nearest.hit.distance, std::numeric_limits<float>::infinity()));
  const FurTreeView& tree = tree_.view();
  const FurRay* prepared = tree.nodes ? rays.prepare(tree, here, start_of(ray)) : nullptr;
  if (!prepared) return false;
  const bool through_door = sees_door(ray);
  StoppingFilter stopping(*this, false, ray.random);
  ScreenDoorFilter door(*this);
  FurFilter& filter = through_door ? static_cast<FurFilter&>(door) : stopping;
  const FurHit found = closest_fur(tree, *prepared, strands_.opaque() ? nullptr : &filter);
  if (!found || !keep(found, through_door, nearest)) return false;
  strand(nearest.hit.strand_index, hit_geometry.strand);
  return true;
}

bool FurChunk::visit_primitives(const Beam& beam, PrimitiveSink& sink) const {
  if (widened_) {
    widened_->visit(tree_.view(), strands_, beam, sink);
  } else {
    visit_segments(tree_.view(), beam, sink);
  }
  return true;
}

void FurChunk::closest_at(std::span<const Ray* const> rays, uint32_t segment, Hit* hits) const {
  std::fill_n(hits, rays.size(), Hit());
  const FurTreeView& tree = tree_.view();
  const FurSegmentLookup::Place place = places_.find(tree, segment);
  if (!place.block) return;
  static_assert(kMaxRays == FurSegmentRays::kMax);
  FurHit found[kMaxRays];
  uint32_t undecided = (1u << rays.size()) - 1;
  FurSegmentPlace at{place.block, place.wide, segment};
  std::vector<Four> memory;
  if (widened_) {
    const WidenedFur::Segment wider =
        widened_->segment(tree, place.block, place.wide, place.lane, strands_.locate(segment).strand);
    at = {wider.write(segment, memory), true, segment};
  }
  if (tree.motion_keys == 1) {
    const SnappedSegment points = read_block(at.block, at.wide, widened_ ? 0 : place.lane, 0);
    undecided = FurSegmentRays::closest(tree, points, segment, rays, found);
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    StoppingFilter filter(*this, true, rays[i]->random);
    if ((undecided >> i & 1) != 0) {
      FurRay prepared;
      found[i] = prepared.prepare(tree, *rays[i], {})
                     ? closest_fur_at(tree, prepared, at, opaque() ? nullptr : &filter)
                     : FurHit();
    } else if (found[i] && !opaque() && !filter.accepts(found[i])) {
      found[i] = {};
    }
    if (found[i]) hits[i] = hit_of(found[i]);
  }
}

bool FurChunk::stops(uint32_t random, uint32_t primitive, float u) const {
  if (!stops_unwidened(random, primitive, u)) return false;
  const FurTreeView& tree = tree_.view();
  const FurSegmentLookup::Place at = places_.find(tree, primitive);
  if (!widened_ || !at.block) return true;
  const PackedStrands::Place place = strands_.locate(primitive);
  const float share = widened_->segment(tree, at.block, at.wide, at.lane, place.strand).share(u);
  const CrossingPlace crossed = crossing(place, u);
  return MinWidth::stops(random, hash64(crossed.strand_id, crossed.part, crossed.joint), share);
}

bool FurChunk::stops_unwidened(uint32_t random, uint32_t primitive, float u) const {
  const PackedStrands::Place place = strands_.locate(primitive);
  return stops_at(random, crossing(place, u), strands_.opacity(place, u));
}

Hit FurChunk::hit_of(const FurHit& found) const {
  const PackedStrands::Place place = strands_.locate(found.number);
  Hit hit;
  hit.kind = HitKind::kStrand;
  hit.distance = found.distance;
  hit.part = part_;
  hit.strand_id = strands_.id(place.strand);
  hit.segment = place.segment;
  hit.u = found.u;
  hit.v = found.h;
  hit.start = start_on(place.strand, static_cast<float>(place.segment) + found.u);
  hit.strand_index = place.strand;
  return hit;
}

/// Replaces `nearest` by a hit that precedes it. Returns whether it did.
bool FurChunk::keep(const FurHit& found, bool through_door, NearestSoFar& nearest) const {
  NearestSoFar candidate;
  candidate.hit = hit_of(found);
  if (through_door) {
    const PackedStrands::Place place = strands_.locate(found.number);
    candidate.hit.v = door(place.strand).offset_inside(found.h, strands_.opacity(place, found.u));
  }
  if (!nearest.comes_after(candidate)) return false;
  nearest = candidate;
  return true;
}

bool FurChunk::collect(const Ray& ray, FurRays& rays, Crossings& crossings) const {
  const FurTreeView& tree = tree_.view();
  const FurRay* prepared = tree.nodes ? rays.prepare(tree, ray, start_of(ray)) : nullptr;
  CollectingFilter collecting(*this, crossings);
  ScreenDoorFilter door(*this);
  const bool counts = crossings.counts();
  FurFilter& filter = sees_door(ray) && !counts ? static_cast<FurFilter&>(door) : collecting;
  return !prepared || !fur_occludes(tree, *prepared, strands_.opaque() && !counts ? nullptr : &filter);
}

ScreenDoor FurChunk::door(uint32_t strand) const { return ScreenDoor(strands_.id(strand), part_); }

CrossingPlace FurChunk::crossing(PackedStrands::Place place, float u) const {
  return {strands_.id(place.strand), part_, place.segment + joint_beside(u)};
}

void FurChunk::strand(uint32_t index, Strands& out) const {
  StrandArrays arrays = strands_.bezier_strand(index, std::move(out).release());
  const FurTreeView& tree = tree_.view();
  const uint32_t first = strands_.first_segment(index), segments = strands_.strand_segments(index);
  const size_t key_floats = size_t(4) * (3 * segments + 1);
  // The segments of a strand are in different leaves.
  for (uint32_t s = 0; s < segments; ++s) fetch_ahead(places_.find(tree, first + s));
  uint32_t not_visible = 0;  // of the first segments
  for (uint32_t s = 0; s < segments; ++s) {
    const FurSegmentLookup::Place place = places_.find(tree, first + s);
    if (!place.block && not_visible == s) {
      ++not_visible;
      continue;
    }
    for (int key = 0; key < tree.motion_keys; ++key) {
      // The last point of a segment is the first of the next.
      float* point = &arrays.points[static_cast<size_t>(key) * key_floats + size_t(12) * s];
      if (!place.block) {
        // It stays at its beginning.
        for (size_t i = 1; i < 4; ++i) std::copy_n(point, 4, point + 4 * i);
        continue;
      }
      const SnappedSegment segment = read_block(place.block, place.wide, place.lane, key);
      for (size_t i = 0; i < 4; ++i, point += 4) {
        for (int axis = 0; axis < 3; ++axis)
          point[axis] = static_cast<float>(
              tree.anchor[axis] + static_cast<double>(segment[i][static_cast<size_t>(axis)]) * tree.step);
        point[3] = segment[i][3] * tree.step;
      }
    }
  }
  const std::array<float, 4> nowhere{tree.anchor.x, tree.anchor.y, tree.anchor.z, 0};
  for (int key = 0; not_visible > 0 && key < tree.motion_keys; ++key) {
    float* points = &arrays.points[static_cast<size_t>(key) * key_floats];
    const float* visible = not_visible < segments ? points + size_t(12) * not_visible : nowhere.data();
    const size_t count = not_visible < segments ? size_t(3) * not_visible : size_t(3) * segments + 1;
    for (size_t i = 0; i < count; ++i) std::copy_n(visible, 4, points + 4 * i);
  }
  out = Strands(std::move(arrays));
}

size_t FurChunk::bytes_bound(const ChunkCounts& n, const FurChunkOptions& options) {
  const size_t segments = n.segments;
  const size_t packed = PackedStrands::bytes_bound(n, PackedPoints::kInFurTree);
  const size_t tree = FurTree::build_bytes_bound(segments, n.motion_keys);
  const size_t widened = options.min_width ? WidenedFur::bytes_bound(n.strands) : 0;
  return bytes_bound(n, sizeof(FurChunk) + widened + grown_bytes_bound(n) + packed +
                            SnappedStrands::bytes(n.strands) + tree +
                            FurSegmentLookup::bytes_bound(segments));
}

size_t FurChunk::bytes_bound(const ChunkCounts& n, size_t build_peak) {
  const size_t packing =
      PackedStrands::bytes_bound(n, PackedPoints::kInFurTree) + PackedStrands::scratch_bytes_bound(n);
  return std::max(sizeof(FurChunk) + grown_bytes_bound(n) + std::max(packing, n.growth_bytes), build_peak);
}

}  // namespace pelage
