// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/vector.h"
#include "geom/limit_surface.h"
#include "image/field.h"

namespace pelage {

class Workers;

/// Relative density of strands over a skin: a field and, where operators restrict a coat, a factor.
struct FollicleDensity {
  Field field{1.0f};
  std::function<float(const V3f& rest, const V3f& normal)> coverage;  ///< may be empty

  bool is_uniform() const { return field.is_constant() && !coverage; }
  /// >= 0; what is not finite counts as 0.
  float at(const SurfaceTopology& topology, const RootAddress& address, const SurfacePoint& point) const;
};

/// A place where a follicle may grow.
struct FollicleCandidate {
  float x = 0, y = 0, z = 0;
  uint32_t normal = 0;  ///< packed, see pack_normal
  float spacing = 1;    ///< 1 / sqrt(density)
  RootAddress root;
};

/// Area of the surface and its integral of the density.
struct SurfaceMeasure {
  double area = 0;
  double mass = 0;
};

/// By 4 x 4 Gauss points per ptex face for the area and a grid of samples for the density.
SurfaceMeasure measure_surface(const LimitSurface& rest, const FollicleDensity& density,
                               const Workers& workers);

/// About `wanted` candidates (how many pass is random) in random order: independent places, with a
/// probability proportional to density times area, each a pure function of (seed, face, number within the
/// face). Density is sampled on a grid per ptex face first, to throw little away where it is low; features of
/// a map thinner than a 32nd of a face may come out thinned.
std::vector<FollicleCandidate> make_candidates(const LimitSurface& rest, const FollicleDensity& density,
                                               uint64_t seed, size_t wanted, const Workers& workers);

/// A unit vector in 3 x 10 bits, to a thousandth.
uint32_t pack_normal(const V3f& normal);
V3f unpack_normal(uint32_t packed);

}  // namespace pelage
