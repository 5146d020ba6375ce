// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/content_store.h"
#include "lab/rays/lab_fur.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Rays of one kind, in the order in which they are traced.
struct LabRays {
  std::string name;     ///< "camera", "gather", "sorted", "shadow", "deep"
  bool shadow = false;  ///< whether anything in the way is enough
  std::vector<Ray> rays;
  std::vector<FurStart> starts;  ///< the strands that they start on
  /// Where an accelerator that knows no such strand begins: two widths from there.
  std::vector<float> clear;

  size_t size() const { return rays.size(); }
};

/// The rays of a measurement, the same for the same scene:
///
/// camera: through points of the picture, tile after tile;
/// gather: from where these hit fur, in all directions, in the order of the hits;
/// sorted: the same rays, by the octant of their direction and then along a space-filling curve;
/// shadow: from where camera rays hit fur to points on lights; none without lights;
/// deep: from places spread evenly over all strands, in all directions.
///
/// `max`: rays of each kind, at most. Throws Error (kArguments) when the camera sees no fur.
std::vector<LabRays> make_lab_rays(const RenderScene& scene, const Strands& strands,
                                   const SnappedStrands& snapped, const FurTree& tree, size_t max);

/// As store_lab_fur().
void store_lab_rays(const ContentStore& store, const std::vector<LabRays>& sets);
std::vector<LabRays> load_lab_rays(const ContentStore& store);

}  // namespace pelage
