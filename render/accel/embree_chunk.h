// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "render/accel/chunk_geometry.h"
#include "render/accel/embree_device.h"
#include "render/accel/packed_strands.h"
#include "render/accel/screen_door.h"
#include "render/scene/render_params.h"

namespace pelage {

struct EmbreeChunkOptions {
  CurveShape shape = CurveShape::kFlat;
  bool compact_attributes = true;
  bool screen_door = false;  ///< secondary rays see strands through a ScreenDoor
};

/// The contents of a resident chunk: packed strands or a skin, and a compact Embree scene over them. All
/// chunks share one Embree device. Thread safety: const members from any thread, each inside a FlushDenormals
/// scope.
class EmbreeChunk final : public ChunkGeometry {
 public:
  /// `number`: identifies this chunk in Ray::start. `widest`: as StrandScale::widest. The calling thread
  /// alone builds the chunk, so chunks may be made inside a parallel loop of another thread pool. Throws
  /// Error for errors that Embree reports. `device` must outlive the chunk.
  EmbreeChunk(ChunkContents contents, uint32_t number, float widest, const EmbreeChunkOptions& options,
              const EmbreeDevice& device, SegmentPatterns& patterns);
  ~EmbreeChunk() override;
  EmbreeChunk(const EmbreeChunk&) = delete;
  EmbreeChunk& operator=(const EmbreeChunk&) = delete;

  bool closest(const Ray& ray, FurRays& rays, NearestSoFar& nearest,
               HitGeometry& hit_geometry) const override;
  /// Supports skins only.
  bool visit_primitives(const Beam& beam, PrimitiveSink& sink) const override;
  /// Finds nothing: segments of this chunk are not passed to sinks.
  void closest_at(std::span<const Ray* const> rays, uint32_t, Hit* hits) const override {
    std::fill_n(hits, rays.size(), Hit());
  }
  bool collect(const Ray& ray, FurRays& rays, Crossings& crossings) const override;
  bool stops(uint32_t random, uint32_t primitive, float u) const override;
  bool opaque() const override { return !strands_ || strands_->opaque(); }

  size_t strand_count() const override { return strands_ ? strands_->strand_count() : 0; }
  StrandKey strand_key(uint32_t index) const override { return {part_, strands_->id(index)}; }
  /// Copies a strand in the basis in which it was grown. Its points are not rounded to a grid. `index`: rank
  /// of the strand, in the order in which they were grown, among the strands with at least one segment.
  /// bezier_segment() can read the copy in every basis.
  void strand(uint32_t index, Strands& out) const override { strands_->copy_strand(index, out); }
  StrandStart start_on(uint32_t index, float place) const override {
    return {number_, strands_->first_segment(index), strands_->strand_segments(index), place};
  }

  const std::optional<PackedStrands>& strands() const { return strands_; }
  const SkinMesh& skin() const { return skin_; }
  /// Bytes of memory in use, including Embree's memory.
  size_t bytes() const override { return bytes_; }
  size_t build_peak_bytes() const override { return build_peak_; }
  /// Upper bound of the memory that a chunk with these counts holds, both while it is made (including the
  /// given contents) and afterwards.
  static size_t bytes_bound(const ChunkCounts& counts);
  /// The same bound, computed from the build_peak_bytes() of a chunk with the same contents.
  static size_t bytes_bound(const ChunkCounts& counts, size_t build_peak);

 private:
  static constexpr size_t kTrianglesPerBox = 32;

  struct Query;
  struct NearestQuery;
  struct LightQuery;
  struct Filters;

  void build();
  void add_curves();
  void add_skin();
  void add_triangle_boxes();
  CrossingPlace crossing(PackedStrands::Place place, float u) const;
  bool starts_here(const Ray& ray) const { return strands_ && ray.start.chunk == number_; }
  bool is_start(const Ray& ray, uint32_t primitive, float u, float distance) const;
  bool v_is_no_offset() const;  // whether Embree's v of a strand is not h
  ScreenDoor door(uint32_t strand) const;
  bool sees_door(const Ray& ray) const { return options_.screen_door && ray.secondary && !opaque(); }

  EmbreeChunkOptions options_;
  const EmbreeDevice& device_;
  uint32_t part_ = 0, number_ = 0;
  float before_ = 0;                      // distance by which Embree's rays start earlier; see embree_ray()
  std::optional<PackedStrands> strands_;  // empty if the chunk is a skin
  SkinMesh skin_;
  std::vector<Box3f> triangle_boxes_;  // of kTrianglesPerBox triangles each, at all times
  float longest_ = 0;                  // see far_behind()
  RTCScene scene_ = nullptr;
  size_t bytes_ = 0, build_peak_ = 0;
};

}  // namespace pelage
