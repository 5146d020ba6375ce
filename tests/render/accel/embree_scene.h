// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/crossings.h"
#include "render/accel/embree_api.h"
#include "render/accel/embree_query.h"
#include "render/scene/render_params.h"

namespace pelage {

class Workers;

/// A batch of strands for ray tracing. The caller must keep the strands and their opacities alive.
struct AccelStrands {
  const Strands* strands = nullptr;
  uint32_t part = 0;               ///< the part that hits report; strand ids must be unique within a part
  std::span<const float> opacity;  ///< one value in [0, 1] per point; empty if all strands are opaque
};

struct EmbreeOptions {
  CurveShape shape = CurveShape::kFlat;
  /// Reduces the tree to a third of its size, and makes incoherent rays 10 to 27 % slower.
  bool compact = false;
  int tessellation_rate = kTessellationRate;  ///< even, 2 to 16
};

/// Control points of a batch of strands in the form that Embree reads, and the mapping from Embree's
/// primitives back to strands. Unpinned B-splines and linear strands are read in place; pinned B-splines and
/// Catmull-Rom strands need a copy with a phantom point at each end.
class EmbreeCurves {
 public:
  explicit EmbreeCurves(const AccelStrands& source);

  const Strands& strands() const { return *source_.strands; }
  uint32_t part() const { return source_.part; }
  bool opaque() const { return source_.opacity.empty(); }

  /// Returns x, y, z and radius of every control point at one motion key: four floats per point.
  const float* vertices(int key) const;
  size_t vertex_count() const { return vertex_count_; }
  /// Index of the first control point of each segment.
  std::span<const uint32_t> segments() const { return first_vertex_; }

  struct Place {
    uint32_t strand = 0;
    uint32_t segment = 0;
  };
  Place locate(uint32_t primitive) const;
  float opacity(Place place, float u) const;
  /// Prefetches the data of a strand that shading will read. Call this for every hit that may become the
  /// nearest, so that the rest of the traversal hides the latency.
  void fetch_ahead(uint32_t primitive) const;

 private:
  void copy_with_phantoms();

  AccelStrands source_;
  size_t vertex_count_ = 0;
  std::vector<float> copy_;                  // control points with phantom ends, or empty: read in place
  std::vector<uint32_t> first_vertex_;       // one per segment
  uint32_t segments_per_strand_ = 0;         // if all strands have the same number; otherwise 0
  uint32_t points_per_strand_ = 0;           // if all strands have the same number; otherwise 0
  std::vector<uint32_t> strand_of_segment_;  // empty if all strands have the same number of segments
  std::vector<uint32_t> first_segment_;  // by strand; empty if all strands have the same number of segments
};

/// The Embree scene of an EmbreeAccel. Also maps Embree's geometry ids to strand batches and skins: batches
/// have the ids from 0, and skins have the ids after the last batch, in the order given to the constructor.
class EmbreeScene {
 public:
  EmbreeScene(const std::vector<AccelStrands>& strands, const std::vector<const SkinMesh*>& skins,
              const EmbreeOptions& options, const Workers& workers);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_; }
  bool opaque() const { return opaque_; }
  bool is_round() const { return options_.shape == CurveShape::kRound; }
  /// Returns the `longest` argument of far_behind() for all strands of the scene; 0 for flat curves.
  float longest_segment() const { return longest_segment_; }
  bool is_skin(uint32_t geometry) const { return geometry >= curves_.size(); }
  uint32_t skin(uint32_t geometry) const { return geometry - static_cast<uint32_t>(curves_.size()); }
  const SkinMesh& skin_mesh(uint32_t geometry) const { return *skins_[skin(geometry)]; }
  const EmbreeCurves& curves(uint32_t geometry) const { return curves_[geometry]; }

  /// Whether hit a precedes hit b at the same distance. Strands precede skins. Hits on strands are ordered by
  /// strand id, then part, then segment. Hits on skins are ordered by geometry id, then triangle.
  bool precedes(uint32_t geometry_a, uint32_t primitive_a, uint32_t geometry_b, uint32_t primitive_b) const;
  CrossingPlace crossing(const EmbreeCurves& batch, EmbreeCurves::Place place, float u) const;

 private:
  void check() const;
  void attach(RTCGeometry geometry, uint32_t id);
  void add_curves(uint32_t id);
  void add_skin(const SkinMesh& mesh, uint32_t id);

  EmbreeOptions options_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::vector<EmbreeCurves> curves_;
  std::vector<const SkinMesh*> skins_;
  bool opaque_ = true;
  float longest_segment_ = 0;
};

}  // namespace pelage
