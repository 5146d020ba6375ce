// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame/camera_samples.h"
#include "render/frame/frame_shading.h"
#include "render/frame/sample_scratch.h"
#include "render/frame/shadow_catcher.h"
#include "render/gather/gather_point_keys.h"
#include "render/gather/index_table.h"
#include "render/gather/light_sharing.h"
#include "render/gather/tile_samples.h"
#include "render/light/direct_light.h"
#include "render/light/far_light_samples.h"

namespace pelage {

/// Finds the lights that the camera samples of a tile see, assigns each visible point to a gather point, and
/// computes the direct light that the visible point would scatter to the camera if nothing blocked the
/// lights. Thread safety: const members may be called from any thread, each with its own scratch.
class VisiblePoints {
 public:
  /// Keeps references to its arguments. `samples`: max samples per pixel that share light.
  VisiblePoints(const FrameScene& scene, const Accel& accel, const FrameShading& shading,
                const CameraSamples& camera, const FarLightSamples& far_lights, uint32_t samples);

  /// A possible target of a shadow ray.
  struct Candidate {
    uint32_t light = 0;
    float mass = 0;  ///< luminance that the point scatters to the camera if nothing blocks the light
    Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};  ///< this light, by lobe group
    V3f direction{0};
    float far = 0;                     ///< length of the shadow ray
    const PartSet* casters = nullptr;  ///< as Ray::casters
    float deviation = 1;               ///< guess of the standard deviation of the fraction that arrives
  };

  struct Scratch {
    DirectLightScratch direct;
    IndexTable gather_points, patches, coats;  // index of each, by its key
    RecentGatherPoints strands;
    std::vector<Candidate> candidates;  // of the current point
    std::vector<float> masses;          // sum of mass * deviation over the candidates, by light

    /// Forgets the gather points, patches and coats of the last tile.
    void clear() {
      gather_points.clear();
      patches.clear();
      coats.clear();
    }
  };

  /// Adds sample `sample` of a pixel to `tile`. `pixel`: index of the pixel in the tile. `hit`: what the
  /// sample sees; `thread` has the geometry. Adds to `sharing` the direct light that its guess expects.
  void add(uint32_t pixel, uint32_t sample, const CameraSample& from, const Hit& hit, Scratch& scratch,
           SampleScratch& thread, LightSharing& sharing, TileSamples& tile) const;

 private:
  void assign(const GatherPointKey& key, Scratch& scratch, TileSamples& tile, VisiblePoint& visible) const;
  void find_light(const ScatterPoint& point, SampleStream& stream, Scratch& scratch, SampleScratch& thread,
                  VisiblePoint& visible, TileSamples& tile) const;
  void expect_light(const VisiblePoint& visible, uint32_t zone, Scratch& scratch,
                    LightSharing& sharing) const;
  void choose_targets(const ScatterPoint& point, float u, Scratch& scratch, TileSamples& tile) const;

  const FrameScene scene_;
  const FrameShading& shading_;
  const CameraSamples& camera_;
  const ShadowCatcher catcher_;
  GatherPointKeys keys_;
  DirectLight direct_;
};

}  // namespace pelage
