// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/ledger.h"
#include "base/progress.h"
#include "base/statistics.h"
#include "render/accel/accel.h"
#include "render/fibre/cone_shell_bsdf.h"
#include "render/render_scene.h"

namespace pelage {

class Workers;

/// One grown leaf of a fur part.
struct FurBatch {
  Strands strands;
  std::vector<float> opacity;  ///< per point, or empty: opaque
  uint32_t part = 0;           ///< of RenderScene::fur
};

/// All fur of a frame, grown, and the tree over fur and skins. Immutable once made.
class FrameGeometry {
 public:
  /// Splits all procedurals, grows their leaves in parallel and builds the tree. Adds strands and chunks to
  /// `statistics`. Throws Error; kInput when a material reads an attribute that the strands do not have.
  /// Returns null when cancelled before everything was grown.
  static std::unique_ptr<const FrameGeometry> make(const RenderScene& scene, const Workers& workers,
                                                   Progress& progress, MemoryLedger& ledger,
                                                   Statistics& statistics);

  const Accel& accel() const { return *accel_; }

 private:
  std::vector<const SkinMesh*> tessellate_skins(const RenderScene& scene, const Workers& workers,
                                                MemoryLedger& ledger);

  std::vector<FurBatch> batches_;
  std::vector<SkinMesh> skins_;
  std::vector<MemoryCharge> charges_;
  std::unique_ptr<Accel> accel_;
};

}  // namespace pelage
