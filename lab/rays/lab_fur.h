// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/content_store.h"
#include "base/job.h"
#include "geom/strands.h"
#include "render/accel/fur/fur_grid.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// All fur of a frame as one batch of strands without attributes, for measuring what traces rays through it.
struct LabFur {
  Strands strands;
  float root_width = 0;  ///< nine of ten strands are no wider at their roots
  V3f centre{0};         ///< of all points

  FurGrid grid() const { return FurGrid(root_width, centre); }
  size_t segment_count() const;
};

/// Grows all coats. Strands get new ids: their places in the batch. Throws Error (kArguments) when the coats
/// have curves of several bases or numbers of motion keys, or when there is no fur; what growing throws.
LabFur grow_lab_fur(const RenderScene& scene, const Job& job);

/// Keeps it beside a measurement for the processes that take part. Throws Error (kFailed) when it cannot be
/// written or read.
void store_lab_fur(const ContentStore& store, const LabFur& fur);
LabFur load_lab_fur(const ContentStore& store);

/// What all entries of one measurement are filed under.
inline constexpr ContentHash kLabKey{0x6c6162, 1};

}  // namespace pelage
