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

/// Finds what the camera samples of a tile see, what light they would reflect if nothing blocked it, and the
/// knots that they belong to. Thread safety: const members from any thread, each with its own scratch.
class VisiblePoints {
 public:
  /// References are kept.
  VisiblePoints(const RenderScene& scene, const FrameShading& shading, const CameraSamples& camera);

  /// What a camera ray sees, as Accel::closest(): stores the geometry in the thread's HitGeometry.
  using FindHit = std::function<Hit(const Ray& ray)>;

  struct Scratch {
    DirectLightScratch direct;
    std::unordered_map<uint64_t, uint32_t> knots, zones;  // indices by key
    std::vector<Reservoir> choices;                       // of a light point, by light

    /// Forgets the knots of the last tile.
    void clear() {
      knots.clear();
      zones.clear();
    }
  };

  /// Adds sample number `sample` of a pixel of the tile; `pixel` is its index within the tile. `find`: uses
  /// `thread`.
  void look(uint32_t pixel, uint32_t sample, const FindHit& find, Scratch& scratch, SampleScratch& thread,
            TileSamples& tile) const;

 private:
  uint32_t knot_of(const KnotKey& key, Scratch& scratch, TileSamples& tile) const;
  void find_light(const ScatterPoint& point, SampleStream& stream, Scratch& scratch, VisiblePoint& visible,
                  TileSamples& tile) const;

  const RenderScene& scene_;
  const FrameShading& shading_;
  const CameraSamples& camera_;
  KnotKeys keys_;
  DirectLight direct_;
};

}  // namespace pelage
