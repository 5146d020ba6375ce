// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/accel/accel.h"
#include "render/film/film.h"
#include "render/film/indirect_clamp.h"
#include "render/frame/tile_costs.h"

namespace pelage {

/// Results, counts and memory of one thread, reused for each sample. An integrator derives its own type.
struct SampleScratch {
  virtual ~SampleScratch() = default;

  FilmSample sample;          ///< result of the last trace()
  std::vector<Rgb> by_layer;  ///< radiance of `sample`, divided among the layers of the film
  IndirectClamp clamp;
  TraceThread thread;
  TileCosts costs;

  /// All rays are traced by these two members, so that each is counted and may be timed.
  Hit closest(RayKind kind, const Accel& accel, Ray ray) {
    ray.secondary = kind != RayKind::kCamera;
    return costs.rays.measure(kind, thread.counts, [&] { return accel.closest(ray, thread); });
  }
  float light_through(const Accel& accel, Ray shadow) {
    shadow.secondary = true;
    return costs.rays.measure(RayKind::kShadow, thread.counts,
                              [&] { return accel.transmittance(shadow, thread); });
  }
};

/// Interface for integrators that compute one sample of a pixel at a time; FrameLoop calls them. A sample
/// depends only on the scene, the pixel and the index of the sample in its pixel. Thread safety: const
/// members may be called from any thread, each with its own scratch.
class SampleIntegrator {
 public:
  virtual ~SampleIntegrator() = default;
  virtual std::unique_ptr<SampleScratch> make_scratch() const = 0;
  /// Computes sample `sample` of pixel (x, y). Stores the result in `scratch`, which must come from
  /// make_scratch().
  virtual void trace(int x, int y, uint32_t sample, SampleScratch& scratch) const = 0;
};

}  // namespace pelage
