// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/ledger.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/accel.h"
#include "render/scene/render_params.h"

namespace pelage {

class EmbreeScene;
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
  /// Number of straight pieces in which a flat segment is tested: even, 2 to 16. embree_curves.h explains the
  /// default.
  int tessellation_rate = 8;
  uint64_t memory_limit = 0;  ///< max bytes of the whole ledger while the tree is built; 0 = no limit
};

/// Accel based on Intel Embree [Wald14]. Flat curves are ribbons that face the ray. Embree ignores hits on
/// flat curves within two radii of the ray's origin. Because this class does not use Ray::start, such hits
/// are lost on all strands. EmbreeChunk ignores them only on the strand that the ray starts on.
class EmbreeAccel final : public Accel {
 public:
  /// Reads points, triangles and opacities in place where Embree can, so `strands` and `skins` must outlive
  /// the accelerator. Charges its allocations to MemoryTag::kChunks. Throws Error: kMemory when the limit is
  /// too small, kFailed for errors of Embree.
  EmbreeAccel(std::vector<AccelStrands> strands, std::vector<const SkinMesh*> skins,
              const EmbreeOptions& options, MemoryLedger& ledger, const Workers& workers);
  ~EmbreeAccel() override;

  Hit closest(const Ray& ray, TraceThread& thread) const override;
  float transmittance(const Ray& ray, TraceThread& thread) const override;
  bool opaque() const override;
  Box3f bounds() const override;

 private:
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace pelage
