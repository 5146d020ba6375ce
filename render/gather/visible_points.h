// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "render/frame/camera_samples.h"
#include "render/frame/frame_shading.h"
#include "render/frame/sample_integrator.h"
#include "render/gather/knot_keys.h"
#include "render/gather/tile_samples.h"
#include "render/light/direct_light.h"
#include "render/sampling/reservoir.h"

namespace pelage {

/// Finds the points and lights that the camera samples of a tile see. Assigns each point to a knot, and
/// computes the direct light that the point would scatter to the camera if nothing blocked the lights. Thread
/// safety: const members may be called from any thread, each with its own scratch.
class VisiblePoints {
 public:
  /// Keeps references to its arguments. `samples`: max samples per pixel that share light.
  VisiblePoints(const RenderScene& scene, const FrameShading& shading, const CameraSamples& camera,
                uint32_t samples);

  /// Returns what a camera ray sees, as Accel::closest() does. Stores the geometry in the thread's
  /// HitGeometry.
  using FindHit = std::function<Hit(const Ray& ray)>;

  struct Scratch {
    DirectLightScratch direct;
    std::unordered_map<uint64_t, uint32_t> knots, zones;  // index of each, by its key
    std::vector<Reservoir> choices;                       // choice of the target of the shadow ray, by light

    /// Forgets the knots and zones of the last tile.
    void clear() {
      knots.clear();
      zones.clear();
    }
  };

  /// Finds what sample `sample` of a pixel sees, and adds the sample to `tile`. `pixel`: index of the pixel
  /// in the tile. `known`: the camera sample, or null if it must be made. `find`: uses `thread`.
  void look(uint32_t pixel, uint32_t sample, const CameraSample* known, const FindHit& find, Scratch& scratch,
            SampleScratch& thread, TileSamples& tile) const;

 private:
  uint32_t knot_of(const KnotKey& key, Scratch& scratch, TileSamples& tile) const;
  void find_light(const ScatterPoint& point, SampleStream& stream, Scratch& scratch, SampleScratch& thread,
                  VisiblePoint& visible, TileSamples& tile) const;

  const RenderScene& scene_;
  const FrameShading& shading_;
  const CameraSamples& camera_;
  KnotKeys keys_;
  DirectLight direct_;
};

}  // namespace pelage
