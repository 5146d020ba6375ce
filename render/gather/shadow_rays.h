// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/job.h"
#include "render/accel/accel.h"
#include "render/frame/sample_integrator.h"
#include "render/gather/knot_order.h"
#include "render/gather/light_sharing.h"
#include "render/gather/tile_samples.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Chooses and traces shadow rays of the visible points of a tile: about `gather.light_rays` per point.
/// Points get more rays if their direct light is bright and uncertain compared to the light of the pixel.
/// Thread safety: const members from any thread, each with its own scratch.
class ShadowRays {
 public:
  /// Keeps references to its arguments.
  ShadowRays(const RenderScene& scene, const Accel& accel) : scene_(scene), accel_(accel) {}

  struct Scratch {
    std::vector<KnotItem> order;      // candidate rays
    std::vector<float> masses;        // masses of the candidate rays, in the same order
    std::vector<double> pixel_light;  // luminance expected to reach the camera, by pixel
  };

  /// Chooses among the rays of `samples.light_rays` from `first` on, using the fractions that `light` has
  /// estimated from earlier rays. Traces the chosen rays and adds the results to `light`. Returns false when
  /// `job` was cancelled.
  bool trace(const TileSamples& samples, size_t first, const Job& job, Scratch& scratch,
             SampleScratch& thread, LightSharing& light) const;

 private:
  double add_unoccluded(const TileSamples& samples, size_t first, Scratch& scratch,
                        LightSharing& light) const;
  double weigh(const TileSamples& samples, double darkest, const LightSharing& light, Scratch& scratch) const;

  const RenderScene& scene_;
  const Accel& accel_;
};

}  // namespace pelage
