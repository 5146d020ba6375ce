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
  std::string name;     ///< kind: "camera", "gather", "sorted", "shadow" or "deep"
  bool shadow = false;  ///< whether to find any hit instead of the nearest hit
  std::vector<Ray> rays;
  std::vector<FurStart> starts;  ///< for each ray: the point on a strand where it starts, or none
  /// For each ray: distance from the origin at which it starts for accelerators that cannot use `starts`. It
  /// is two widths of the strand.
  std::vector<float> clear;

  size_t size() const { return rays.size(); }
};

/// Returns the rays of a measurement. The same scene always gives the same rays. The kinds are:
///
/// - camera: through points of the picture, tile by tile
/// - gather: from the hits of camera rays on fur, in random directions, in the order of these hits
/// - sorted: the gather rays, sorted by the octant of their direction, then by origin along a space-filling
///   curve
/// - shadow: from the hits of camera rays on fur to points on lights; omitted if the scene has no lights
/// - deep: from points spread evenly over all strands, in random directions
///
/// `max` is the max number of rays of each kind. Throws Error (kArguments) when the camera sees no fur.
std::vector<LabRays> make_lab_rays(const RenderScene& scene, const Strands& strands,
                                   const SnappedStrands& snapped, const FurTree& tree, size_t max);

/// Stores and loads rays in the same way as store_lab_fur() and load_lab_fur().
void store_lab_rays(const ContentStore& store, const std::vector<LabRays>& sets);
std::vector<LabRays> load_lab_rays(const ContentStore& store);

}  // namespace pelage
