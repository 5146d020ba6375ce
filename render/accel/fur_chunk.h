// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "render/accel/chunk_geometry.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/fur/fur_parts.h"
#include "render/accel/fur/fur_segment_lookup.h"
#include "render/accel/fur/fur_tree.h"
#include "render/accel/packed_strands.h"
#include "render/accel/screen_door.h"
#include "render/accel/widened_fur.h"

namespace pelage {

struct FurChunkOptions {
  FurChunkOptions() { tree.build.rotation = FurRotation::kWhenUseful; }

  FurTreeOptions tree;
  bool compact_attributes = true;
  /// The min width at which the camera sees strands; empty: strands keep their widths.
  std::optional<MinWidth> min_width = {};
  bool screen_door = false;  ///< secondary rays see strands through a ScreenDoor
};

/// A chunk of fur: a fur tree, which has the only copy of the points, and the strands' data for shading (ids,
/// roots, attributes). closest() stores the strand that was hit as Bezier curves on the grid of the coat.
/// These are exactly the curves that rays hit.
class FurChunk final : public ChunkGeometry {
 public:
  /// Builds the chunk on the calling thread. `contents` must be fur. `number`: identifies this chunk in
  /// Ray::start. `grid`: must be the same for all chunks of a coat.
  FurChunk(ChunkContents contents, uint32_t number, const FurGrid& grid, const FurChunkOptions& options);

  /// Makes a chunk from data that was read from a file.
  FurChunk(uint32_t part, uint32_t number, PackedStrands strands, FurTree tree);

  /// From now on, the camera sees strands with a min width. Affects visit_primitives(), closest_at(), stops()
  /// and opaque(), but no other member. Call before other threads use the chunk.
  void widen(const MinWidth& min);

  /// Undoes widen().
  void unwiden();
  /// Sets FurChunkOptions::screen_door. Call before other threads use the chunk.
  void set_screen_door(bool on) { screen_door_ = on; }
  /// Gives the chunk the numbers of another frame (see the constructor and ChunkContents::part). Call before
  /// other threads use the chunk.
  void renumber(uint32_t part, uint32_t number) {
    part_ = part;
    number_ = number;
  }

  bool closest(const Ray& ray, FurRays& rays, NearestSoFar& nearest,
               HitGeometry& hit_geometry) const override;
  bool visit_primitives(const Beam& beam, PrimitiveSink& sink) const override;
  void closest_at(std::span<const Ray* const> rays, uint32_t segment, Hit* hits) const override;
  bool collect(const Ray& ray, FurRays& rays, Crossings& crossings) const override;
  bool stops(uint32_t random, uint32_t primitive, float u) const override;
  bool opaque() const override { return strands_.opaque() && !widened_; }

  size_t strand_count() const override { return strands_.strand_count(); }
  StrandKey strand_key(uint32_t index) const override { return {part_, strands_.id(index)}; }
  /// Copies a strand as Bezier curves on the grid of the coat. `index`: rank of the strand in ascending order
  /// of ids. Rays never hit segments whose points are not finite, and the copy replaces these segments. At
  /// the beginning of a strand, they collapse to the first point of the first finite segment; at the end, to
  /// the last point of the last finite segment. Between finite segments, they become a straight connection.
  void strand(uint32_t index, Strands& out) const override;
  StrandStart start_on(uint32_t index, float place) const override {
    return {number_, strands_.first_segment(index), strands_.strand_segments(index), place};
  }

  uint32_t part() const { return part_; }
  const FurTree& tree() const { return tree_; }
  const PackedStrands& strands() const { return strands_; }
  size_t segment_count() const { return strands_.segment_count(); }
  /// Returns about `parts` boxes that together contain every hit, or fewer if the tree has fewer leaves.
  ChunkBounds part_bounds(size_t parts) const;
  size_t bytes() const override { return bytes_; }
  size_t build_peak_bytes() const override { return build_peak_; }
  /// Upper bound of the memory that a chunk with these counts holds, both while it is made (including the
  /// given contents) and afterwards.
  static size_t bytes_bound(const ChunkCounts& counts, const FurChunkOptions& options);
  /// The same bound, computed from the build_peak_bytes() of a chunk with the same contents.
  static size_t bytes_bound(const ChunkCounts& counts, size_t build_peak);

 private:
  class StoppingFilter;
  class CollectingFilter;
  class ScreenDoorFilter;

  FurChunk(const FurContents& grown, uint32_t part, uint32_t number, const FurGrid& grid,
           const FurChunkOptions& options);
  FurStart start_of(const Ray& ray) const;
  bool keep(const FurHit& found, bool through_door, NearestSoFar& nearest) const;
  bool sees_door(const Ray& ray) const { return screen_door_ && ray.secondary && !strands_.opaque(); }
  Hit hit_of(const FurHit& found) const;
  bool stops_unwidened(uint32_t random, uint32_t primitive, float u) const;
  CrossingPlace crossing(PackedStrands::Place place, float u) const;
  ScreenDoor door(uint32_t strand) const;

  uint32_t part_, number_;
  PackedStrands strands_;
  FurTree tree_;
  FurSegmentLookup places_;
  std::unique_ptr<const WidenedFur> widened_;
  bool screen_door_ = false;
  size_t bytes_ = 0, build_peak_ = 0;
};

}  // namespace pelage
