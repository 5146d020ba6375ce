// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/fibre_tracer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/hash.h"
#include "render/fibre/core_walk.h"
#include "render/fibre/dielectric.h"

namespace pelage {
namespace {

float reflectance(const TracedFibre& fibre, float outside_cosine) {
  return fibre.layers > 0 ? cuticle_reflectance(outside_cosine, fibre.eta, fibre.layers)
                          : dielectric_reflectance(outside_cosine, fibre.eta);
}

}  // namespace

FibrePath trace_fibre(const TracedFibre& fibre, float sin_theta_o, float h, uint64_t seed, uint64_t number) {
  WalkRandom random(hash64(seed, random_use("fibre tracer"), number));
  const float cos_theta_o = std::sqrt(std::max(0.0f, (1 - sin_theta_o) * (1 + sin_theta_o)));
  const V3f wo(sin_theta_o, cos_theta_o, 0);
  const V3f entry(0, std::sqrt(std::max(0.0f, (1 - h) * (1 + h))), -h);
  const float cosine = wo.dot(entry);

  FibrePath path;
  if (random.unit() < reflectance(fibre, cosine)) {
    path.wi = 2 * cosine * entry - wo;
    return path;
  }
  path.entered = true;
  const float inside = std::sqrt(std::max(0.0f, 1 - (1 - cosine * cosine) / (fibre.eta * fibre.eta)));
  CoreWalk walk{{entry.y, entry.z}, (cosine / fibre.eta - inside) * entry - wo / fibre.eta};
  for (;;) {
    if (const std::optional<float> to_core = walk.length_in(fibre.medulla)) {
      path.cortex += *to_core;
      walk.advance(*to_core);
      path.scattered |= walk.cross(fibre.medulla, fibre.scattering, fibre.anisotropy, random, path.core);
    }
    const float to_surface = walk.length_out(1);
    path.cortex += to_surface;
    walk.advance(to_surface);
    walk.position.normalize();
    const V3f normal(0, walk.position.x, walk.position.y);
    const float within = std::clamp(walk.direction.dot(normal), 0.0f, 1.0f);
    const float outside2 = 1 - (1 - within * within) * fibre.eta * fibre.eta;
    if (outside2 > 0) {  // otherwise total reflection
      const float outside = std::sqrt(outside2);
      if (random.unit() >= reflectance(fibre, outside)) {
        path.wi = fibre.eta * walk.direction + (outside - fibre.eta * within) * normal;
        path.wi.normalize();
        return path;
      }
    }
    walk.direction -= 2 * within * normal;
    ++path.reflections;
  }
}

}  // namespace pelage
