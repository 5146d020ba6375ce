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

/// A batch of strands to be met by rays. Both are kept alive by the caller.
struct AccelStrands {
  const Strands* strands = nullptr;
  uint32_t part = 0;               ///< what hits call it: strand ids are unique within a part
  std::span<const float> opacity;  ///< one in [0, 1] per point, or empty: opaque
};

struct EmbreeOptions {
  CurveShape shape = CurveShape::kFlat;
  bool compact = false;  ///< a third of the tree's memory for 10 to 27 % of the speed of incoherent rays
  /// Pieces that a flat segment is tested in: even, 2 to 16. See embree_curves.h for why 8.
  int tessellation_rate = 8;
  uint64_t memory_limit = 0;  ///< bytes that the whole ledger may reach while the tree is built; 0 = no limit
};

/// Accel by Intel Embree [Wald14]. Flat curves are ray-facing ribbons; a hit nearer than two radii to the
/// start of a ray is not seen, on any strand; of the strand that a ray starts on it knows nothing. Chunks are
/// better at both (EmbreeChunk).
class EmbreeAccel final : public Accel {
 public:
  /// Points, triangles and opacities are read in place wherever Embree can, so `strands` and `skins` must
  /// outlive the accelerator. What it allocates is charged to MemoryTag::kChunks. Throws Error: kMemory when
  /// the limit is too small, kFailed for what Embree reports.
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
