// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
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

/// A place where a follicle may grow. Many candidates are in memory at a time, so every byte counts.
struct FollicleCandidate {
  float x = 0, y = 0, z = 0;
  uint32_t normal = 0;   ///< packed, see pack_normal
  float spacing = 1;     ///< 1 / sqrt(density)
  uint32_t attempt = 0;  ///< its number among all attempts, see FollicleCandidates::root()
  uint32_t number = 0;   ///< random number that defines the order of candidates; later the rank in that order
};

/// Part of the candidates: those whose random numbers lie in [begin, end).
struct CandidateShare {
  uint64_t begin = 0, end = uint64_t(1) << 32;
};

/// Properties of all candidates together. They must be known before the first candidate is used.
struct CandidateSurvey {
  size_t count = 0;
  Box3f box;
  float smallest_spacing = std::numeric_limits<float>::infinity();

  void add(const FollicleCandidate& candidate) {
    ++count;
    box.extendBy(V3f(candidate.x, candidate.y, candidate.z));
    smallest_spacing = std::min(smallest_spacing, candidate.spacing);
  }
};

/// Area of the surface and its integral of the density.
struct SurfaceMeasure {
  double area = 0;
  double mass = 0;
};

/// Integrates the area with 4 x 4 Gauss points per ptex face, and the density with a grid of samples.
SurfaceMeasure measure_surface(const LimitSurface& rest, const FollicleDensity& density, const Job& job);

/// Per-face data for making candidates: its area, and bounds for rejection.
struct FaceStatistics {
  double area = 0;
  double mass = 0;
  float largest_element = 0;  ///< max of |du x dv| over samples
  float largest_density = 0;
};

/// Makes candidates: independent places, with a probability proportional to density times area, each a pure
/// function of (seed, face, number within the face). Density is sampled on a grid per ptex face first, so
/// that few candidates are rejected where it is low; features of a map that are thinner than a 32nd of a face
/// may get too few candidates. The surface and the density must outlive this object.
class FollicleCandidates {
 public:
  /// Throws Error (kInput) if the density is so uneven that too many places would have to be tried.
  FollicleCandidates(const LimitSurface& rest, const FollicleDensity& density, uint64_t seed, size_t wanted,
                     const Job& job);

  /// Makes the candidates of a share, in random order. The full range has about `wanted` candidates; the
  /// exact number is random.
  std::vector<FollicleCandidate> make(const Job& job, const CandidateShare& share = {}) const;
  /// The survey of all candidates that make() returns; keeps none of them in memory.
  CandidateSurvey survey(const Job& job) const;
  /// Max number of candidates to expect when `wanted` are requested.
  static constexpr uint64_t max_of(uint64_t wanted) { return wanted + wanted / 64 + 1024; }
  /// Approximate number of candidates that make() returns without a share.
  size_t wanted() const { return wanted_; }
  /// Root of a candidate on the skin. Stores its position in `position`.
  RootAddress root(uint32_t attempt, V3f* position) const;

 private:
  /// Calls visit(candidate) for the candidates of [begin, end) that are in the share.
  template <class Visit>
  void try_all(uint64_t begin, uint64_t end, const CandidateShare& share, const Visit& visit) const;
  size_t face_of(uint64_t attempt) const;
  uint64_t stream(size_t face, uint64_t attempt) const;
  uint64_t order_key(uint64_t attempt) const;

  const LimitSurface& rest_;
  const FollicleDensity& density_;
  const uint64_t seed_;
  const size_t wanted_;
  const float room_;  // factor on the largest sampled density, for values between the samples
  std::vector<FaceStatistics> faces_;
  std::vector<uint64_t> first_;  // first attempt of each face, then the total number
};

/// A unit vector in 3 x 10 bits, accurate to a thousandth.
uint32_t pack_normal(const V3f& normal);
V3f unpack_normal(uint32_t packed);

}  // namespace pelage
