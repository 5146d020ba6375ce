// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/accel/chunk_geometry.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/fur/fur_parts.h"
#include "render/accel/fur/fur_segment_lookup.h"
#include "render/accel/fur/fur_tree.h"
#include "render/accel/packed_strands.h"

namespace pelage {

struct FurChunkOptions {
  FurChunkOptions() { tree.build.rotation = FurRotation::kWhenUseful; }

  FurTreeOptions tree;
  bool compact_attributes = true;
};

/// Fur of one part in a fur tree, which has the only copy of the points, and the strands' data for shading:
/// ids, roots, attributes. Hits return strands of Bezier curves on the grid of the coat, the curves that were
/// hit.
class FurChunk final : public ChunkGeometry {
 public:
  /// `number`: identifies this chunk in Ray::start. `grid`: the same for all chunks of a coat. Built by the
  /// calling thread only.
  FurChunk(ChunkContents contents, uint32_t number, const FurGrid& grid, const FurChunkOptions& options);

  /// A chunk that was stored in a file.
  FurChunk(uint32_t part, uint32_t number, PackedStrands strands, FurTree tree);

  bool closest(const Ray& ray, FurRays& rays, NearestSoFar& nearest, HitGeometry& met) const override;
  bool visit_primitives(const Beam& beam, PrimitiveSink& sink) const override;
  bool closest_at(const Ray& ray, uint32_t primitive, FurRays& rays, NearestSoFar& nearest,
                  HitGeometry& met) const override;
  bool collect(const Ray& ray, FurRays& rays, Crossings& crossings) const override;
  bool stops(uint32_t random, uint32_t primitive, float u) const override;
  bool opaque() const override { return strands_.opaque(); }

  size_t strand_count() const override { return strands_.strand_count(); }
  StrandKey strand_key(uint32_t index) const override { return {part_, strands_.id(index)}; }
  /// Bezier curves on the grid of the coat, strands in ascending order of their ids. No ray hits segments
  /// whose points are not finite. At the beginning of a strand, such segments collapse to the first point of
  /// the remaining segments; between others, they become a connection from joint to joint.
  void strand(uint32_t index, Strands& out) const override;
  StrandStart start_on(uint32_t index, float place) const override {
    return {number_, strands_.first_segment(index), strands_.strand_segments(index), place};
  }

  uint32_t part() const { return part_; }
  const FurTree& tree() const { return tree_; }
  const PackedStrands& strands() const { return strands_; }
  size_t segment_count() const { return strands_.segment_count(); }
  /// About `parts` boxes that contain every hit.
  ChunkBounds part_bounds(size_t parts) const;
  size_t bytes() const override { return bytes_; }
  size_t build_peak_bytes() const override { return build_peak_; }
  /// Upper bound of the memory held at any moment while a chunk with these counts is made, including the
  /// given contents, and afterwards.
  static size_t bytes_bound(const ChunkCounts& counts, const FurChunkOptions& options);
  /// The same when the build_peak_bytes() of an equal chunk are known.
  static size_t bytes_bound(const ChunkCounts& counts, size_t build_peak);

 private:
  class StoppingFilter;
  class CollectingFilter;

  FurChunk(const FurContents& grown, uint32_t part, uint32_t number, const FurGrid& grid,
           const FurChunkOptions& options);
  FurStart start_of(const Ray& ray) const;
  bool keep(const FurHit& found, NearestSoFar& nearest) const;
  CrossingPlace crossing(PackedStrands::Place place, float u) const;

  uint32_t part_, number_;
  PackedStrands strands_;
  FurTree tree_;
  FurSegmentLookup places_;
  size_t bytes_ = 0, build_peak_ = 0;
};

}  // namespace pelage
