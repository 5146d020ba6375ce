// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/accel/crossings.h"
#include "render/accel/embree_curves.h"
#include "render/accel/embree_device.h"

namespace pelage {

/// The Embree scene of an EmbreeAccel. Also maps Embree's geometry ids to strand batches and skins: batches
/// have the ids from 0, and skins have the ids after the last batch, in the order given to the constructor.
class EmbreeScene {
 public:
  EmbreeScene(const std::vector<AccelStrands>& strands, const std::vector<const SkinMesh*>& skins,
              const EmbreeOptions& options, MemoryLedger& ledger, const Workers& workers);
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
  void attach(RTCGeometry geometry, uint32_t id);
  void add_curves(uint32_t id);
  void add_skin(const SkinMesh& mesh, uint32_t id);

  EmbreeOptions options_;
  EmbreeDevice device_;
  RTCScene scene_ = nullptr;
  std::vector<EmbreeCurves> curves_;
  std::vector<const SkinMesh*> skins_;
  bool opaque_ = true;
  float longest_segment_ = 0;
  MemoryCharge charge_;
};

}  // namespace pelage
