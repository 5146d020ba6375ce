// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/content_store.h"
#include "lab/rays/lab_fur.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Rays of one kind, in the order of tracing.
struct LabRays {
  std::string name;     ///< "camera", "gather", "sorted", "shadow", "deep"
  bool shadow = false;  ///< whether any hit suffices
  std::vector<Ray> rays;
  std::vector<FurStart> starts;  ///< the strands that they start on
  /// Start distance for accelerators that do not use `starts`: two widths.
  std::vector<float> clear;

  size_t size() const { return rays.size(); }
};

/// The rays of a measurement, the same for the same scene:
///
/// camera: through points of the picture, tile by tile; gather: from the hits of camera rays on fur, in all
/// directions, in the order of the hits; sorted: the gather rays, sorted by the octant of their direction and
/// along a space-filling curve; shadow: from the hits of camera rays on fur to points on lights; none without
/// lights; deep: from points spread evenly over all strands, in all directions.
///
/// `max`: max number of rays of each kind. Throws Error (kArguments) when the camera sees no fur.
std::vector<LabRays> make_lab_rays(const RenderScene& scene, const Strands& strands,
                                   const SnappedStrands& snapped, const FurTree& tree, size_t max);

/// As store_lab_fur().
void store_lab_rays(const ContentStore& store, const std::vector<LabRays>& sets);
std::vector<LabRays> load_lab_rays(const ContentStore& store);

}  // namespace pelage
