// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/content_store.h"
#include "base/job.h"
#include "geom/strands.h"
#include "render/accel/fur/fur_grid.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// All fur of a frame as one batch of strands without attributes, for measuring accelerators.
struct LabFur {
  Strands strands;
  float root_width = 0;  ///< 90th percentile of the strands' widths at their roots
  V3f centre{0};         ///< of all points

  FurGrid grid() const { return FurGrid(root_width, centre); }
  size_t segment_count() const;
};

/// Grows all coats. Strands get new ids: their indices in the batch. Throws Error (kArguments) when the coats
/// differ in basis or number of motion keys, or when there is no fur. Passes on errors of growth.
LabFur grow_lab_fur(const RenderScene& scene, const Job& job);

/// Stores the fur for all processes of a measurement. Throws Error (kFailed) when it cannot be written or
/// read.
void store_lab_fur(const ContentStore& store, const LabFur& fur);
LabFur load_lab_fur(const ContentStore& store);

/// Key of all entries of one measurement.
inline constexpr ContentHash kLabKey{0x6c6162, 1};

}  // namespace pelage
