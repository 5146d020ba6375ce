// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>

#include "render/frame/camera_samples.h"
#include "render/frame/frame_shading.h"
#include "render/frame/sample_integrator.h"
#include "render/frame/tile_order.h"
#include "render/gather/knot_keys.h"
#include "render/gather/tile_samples.h"
#include "render/light/direct_light.h"

namespace pelage {

/// Chooses one of a sequence of items in proportion to their mass.
class Reservoir {
 public:
  /// `u`: a random number in [0, 1).
  explicit Reservoir(float u) : u_(u) {}
  /// Whether the item replaces the one chosen before.
  bool takes(float mass);
  float sum() const { return sum_; }

 private:
  float u_, sum_ = 0;
};

/// Finds what the camera samples of a tile see, what light they would reflect if nothing blocked it, and the
/// knots that they belong to. Thread safety: const members from any thread, each with its own scratch.
class VisiblePoints {
 public:
  /// References are kept.
  VisiblePoints(const RenderScene& scene, const Accel& accel, const FrameShading& shading,
                const FilmLayers& layers);

  struct Scratch {
    DirectLightScratch direct;
    std::unordered_map<uint64_t, uint32_t> knots, layers;  // by key
    std::vector<Reservoir> choices;                        // of a light point, by light
  };

  /// Adds sample number `sample` of pixel (x, y) to `tile`; `pixel` is the index of the pixel within it.
  void look(int x, int y, uint32_t pixel, uint32_t sample, Scratch& scratch, SampleScratch& trace,
            TileSamples& tile) const;

 private:
  uint32_t knot_of(const KnotKey& key, Scratch& scratch, TileSamples& tile) const;
  void find_light(const ScatterPoint& point, SampleStream& stream, Scratch& scratch, VisiblePoint& visible,
                  TileSamples& tile) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const FrameShading& shading_;
  CameraSamples camera_;
  KnotKeys keys_;
  DirectLight direct_;
};

}  // namespace pelage
