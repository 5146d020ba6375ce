// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/content_store.h"
#include "base/job.h"
#include "geom/strands.h"
#include "render/accel/fur/fur_grid.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// All fur of a frame as one batch of strands without attributes, for measurements of ray accelerators.
struct LabFur {
  Strands strands;
  float root_width = 0;  ///< 90th percentile of the strands' widths at their roots
  V3f centre{0};         ///< centre of the box of all points

  FurGrid grid() const { return FurGrid(root_width, centre); }
  size_t segment_count() const;
};

/// Grows all coats of a scene. The new id of a strand is its index in the batch. Throws Error (kArguments)
/// when the coats have different bases or numbers of motion keys, or when there is no fur or too much. Passes
/// on errors of growth.
LabFur grow_lab_fur(const RenderScene& scene, const Job& job);

/// Stores the fur, so that each process of a measurement can load it. Throws Error (kFailed) when it cannot
/// be written.
void store_lab_fur(const ContentStore& store, const LabFur& fur);
/// Loads the stored fur. Throws Error (kFailed) when it cannot be read.
LabFur load_lab_fur(const ContentStore& store);

/// Key of every entry in the store of a measurement.
inline constexpr ContentHash kLabKey{0x6c6162, 1};

}  // namespace pelage
