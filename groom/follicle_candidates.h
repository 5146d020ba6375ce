// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/vector.h"
#include "geom/limit_surface.h"
#include "image/field.h"

namespace pelage {

struct Job;

/// Relative density of strands over a skin: a field and, when operators restrict a coat, a factor.
struct FollicleDensity {
  Field field{1.0f};
  std::function<float(const V3f& rest, const V3f& normal)> coverage;  ///< may be empty

  bool is_uniform() const { return field.is_constant() && !coverage; }
  /// >= 0; a non-finite value counts as 0.
  float at(const SurfaceTopology& topology, const RootAddress& address, const SurfacePoint& point) const;
};

/// A place where a follicle may grow. There are several per follicle, so every byte counts.
struct FollicleCandidate {
  float x = 0, y = 0, z = 0;
  uint32_t normal = 0;   ///< packed, see pack_normal
  float spacing = 1;     ///< 1 / sqrt(density)
  uint32_t attempt = 0;  ///< its number among all attempts, see FollicleCandidates::root()
  uint32_t next = 0;     ///< for linked lists of the code that owns the candidates
};

/// Area of the surface and its integral of the density.
struct SurfaceMeasure {
  double area = 0;
  double mass = 0;
};

/// By 4 x 4 Gauss points per ptex face for the area and a grid of samples for the density.
SurfaceMeasure measure_surface(const LimitSurface& rest, const FollicleDensity& density, const Job& job);

/// Per-face data for making candidates: its area, and bounds for rejection.
struct FaceStatistics {
  double area = 0;
  double mass = 0;
  float largest_element = 0;  ///< max of |du x dv| over samples
  float largest_density = 0;
};

/// Makes candidates: independent places, with a probability proportional to density times area, each a pure
/// function of (seed, face, number within the face). Density is sampled on a grid per ptex face first, to
/// throw little away where it is low; features of a map thinner than a 32nd of a face may come out thinned.
/// Refers to the surface and the density.
class FollicleCandidates {
 public:
  /// Throws Error (kInput) where the density is so uneven that too many places would have to be tried.
  FollicleCandidates(const LimitSurface& rest, const FollicleDensity& density, uint64_t seed, size_t wanted,
                     const Job& job);

  /// About `wanted` candidates (the number that pass is random), in random order.
  std::vector<FollicleCandidate> make(const Job& job) const;
  /// Position of a candidate on the skin.
  RootAddress root(const FollicleCandidate& candidate) const;

 private:
  size_t face_of(uint64_t attempt) const;
  uint64_t stream(size_t face, uint64_t attempt) const;
  uint64_t order_key(uint64_t attempt) const;

  const LimitSurface& rest_;
  const FollicleDensity& density_;
  const uint64_t seed_;
  const size_t wanted_;
  const float room_;  // factor on the largest sampled density, for values between the samples
  std::vector<FaceStatistics> faces_;
  std::vector<uint64_t> first_;  // attempt of each face, and their number
};

/// A unit vector in 3 x 10 bits, accurate to a thousandth.
uint32_t pack_normal(const V3f& normal);
V3f unpack_normal(uint32_t packed);

}  // namespace pelage
