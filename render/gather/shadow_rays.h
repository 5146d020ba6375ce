// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/job.h"
#include "render/accel/accel.h"
#include "render/frame/sample_scratch.h"
#include "render/gather/gather_point_order.h"
#include "render/gather/light_sharing.h"
#include "render/gather/tile_samples.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// Chooses and traces shadow rays from the visible points of a tile: on average, about `gather.light_rays`
/// per point. A point gets more rays if its unoccluded direct light is bright compared to the light of its
/// pixel, and the visibility of this direct light is uncertain. Without reuse, each point gets
/// `render.light_samples` + 1 rays, as with `path`: these rays, and one whose direction is sampled from the
/// lobes.
/// Thread safety: const members may be called from any thread, each with its own scratch.
class ShadowRays {
 public:
  /// Keeps references to its arguments.
  ShadowRays(const FrameScene& scene, const Accel& accel)
      : scene_(scene), accel_(accel), guesses_(scene.render.gather.reuse) {}

  /// A traced ray.
  struct Pilot {
    uint32_t ray = 0;   ///< index in TileSamples::light_rays
    float factor = 0;   ///< weight / light of the ray
    float through = 0;  ///< fraction that the ray transmits
  };
  struct Scratch {
    GatherPointOrder order;           // candidate rays, sorted by gather point and light
    std::vector<float> masses;        // masses for SystematicChoice of the rays in `order`
    std::vector<double> pixel_light;  // direct luminance that is expected to reach the camera, by pixel
    std::vector<Pilot> pilots;        // rays of the first call that were traced
    std::vector<ArrivalGuess::Sums>
        own;  // of the rays of one gather point, by group of lights and range of directions
  };

  /// Chooses some of the rays of `samples.light_rays` from index `first` on. Traces the chosen rays and adds
  /// the results to `light`. Returns false when `job` was cancelled.
  ///
  /// The first call of a tile, with `first` = 0, is the pilot. LightSharing::guess() learns from its rays,
  /// and the call adds the expected light of its points to `light`. Before each later call, the caller adds
  /// the expected light of all candidates of the points of that call (see LightSharing).
  bool trace(const TileSamples& samples, size_t first, const Job& job, Scratch& scratch,
             SampleScratch& thread, LightSharing& light) const;

 private:
  double expect(const TileSamples& samples, size_t first, const ArrivalGuess& guess, Scratch& scratch) const;
  double weigh(const TileSamples& samples, double darkest, const ArrivalGuess& guess, Scratch& scratch) const;
  void finish_pilot(const TileSamples& samples, Scratch& scratch, LightSharing& light) const;

  const FrameScene scene_;
  const Accel& accel_;
  const bool guesses_;  // otherwise, each point only uses its own rays
};

}  // namespace pelage
