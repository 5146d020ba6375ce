// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/accel/accel.h"
#include "render/film/film.h"
#include "render/film/indirect_clamp.h"
#include "render/frame/tile_costs.h"

namespace pelage {

struct FrameStatistics;

/// Results, counts and memory of one thread, reused for each sample. An integrator derives its own type.
struct SampleScratch {
  virtual ~SampleScratch() = default;
  /// Adds the counts of the thread: of rays, of accelerator work, of rejected samples and of the integrator.
  virtual void add_to(FrameStatistics& statistics) const;

  FilmSample sample;          ///< the last one
  std::vector<Rgb> by_layer;  ///< radiance of `sample`, divided among the layers of the film
  IndirectClamp clamp;
  TraceThread thread;
  TileCosts costs;
  int64_t rejected = 0;  ///< samples that were not finite

  /// All rays are traced by these two members, so that each is counted and may be timed.
  Hit closest(RayKind kind, const Accel& accel, Ray ray) {
    ray.secondary = kind != RayKind::kCamera;
    return costs.rays.measure(kind, thread.counts, [&] { return accel.closest(ray, thread); });
  }
  float light_through(const Accel& accel, Ray shadow) {
    if (shadow.casters && shadow.casters->empty()) return 1;
    shadow.secondary = true;
    return costs.rays.measure(RayKind::kShadow, thread.counts,
                              [&] { return accel.transmittance(shadow, thread); });
  }
  StrandCount strands_crossed(const Accel& accel, Ray shadow, uint32_t max) {
    if (shadow.casters && shadow.casters->empty()) return {};
    return costs.rays.measure(RayKind::kShadow, thread.counts,
                              [&] { return accel.strands_crossed(shadow, max, thread); });
  }
};

}  // namespace pelage
