// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "base/vector.h"
#include "geom/limit_surface.h"
#include "image/field.h"

namespace pelage {

struct Job;

/// Number of candidates made per follicle. More candidates pack the last follicles more tightly, at
/// proportional cost.
inline constexpr size_t kCandidatesPerFollicle = 6;

/// Density of strands over a skin: a field, times a factor if operators restrict where the coat grows.
class FollicleDensity {
 public:
  /// `coverage`: the factor; may be empty.
  explicit FollicleDensity(Field field = Field(1.0f),
                           std::function<float(const FieldPoint& root)> coverage = {});

  bool is_uniform() const { return uniform_; }
  /// Returns the density at a point of the skin, >= 0. A value that is not finite counts as 0.
  float at(const SurfaceTopology& topology, const RootAddress& address, const SurfacePoint& point) const;

 private:
  Field field_;
  std::function<float(const FieldPoint& root)> coverage_;
  bool uniform_, needs_normal_;  // cached: asking the field costs as much as evaluating it
};

/// A point of the skin where a follicle may grow. Small, because many candidates are in memory at a time.
struct FollicleCandidate {
  float x = 0, y = 0, z = 0;
  uint32_t normal = 0;   ///< unit normal of the skin, see pack_normal()
  float spacing = 1;     ///< 1 / sqrt(density)
  uint32_t attempt = 0;  ///< number of the attempt that made it, see FollicleCandidates::root()
  /// Random number by which candidates are sorted; after CandidateSupply::next() or take_all(), rank in that
  /// order.
  uint32_t number = 0;
};

/// A part of all candidates: those whose random numbers lie in [begin, end).
struct CandidateShare {
  uint64_t begin = 0, end = uint64_t(1) << 32;
};

/// Properties of the set of all candidates. Needed before the first candidate is used.
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

/// Data of a ptex face for making candidates: integrals, and max values over samples for rejection sampling.
struct FaceStatistics {
  double area = 0;
  double mass = 0;            ///< integral of the density over the area
  float largest_element = 0;  ///< max over the samples of |du x dv|
  float largest_density = 0;  ///< max over the samples of the density
};

/// Area of a surface, and integral of the density over that area.
struct SurfaceMeasure {
  double area = 0;
  double mass = 0;
  std::vector<FaceStatistics> faces;  ///< by ptex face
};

/// Integrates over a surface: the area with 4 x 4 Gauss points per ptex face, the density with a grid of
/// samples per ptex face.
SurfaceMeasure measure_surface(const LimitSurface& rest, const FollicleDensity& density, const Job& job);

/// Makes candidates by rejection sampling: independent points whose probability is proportional to density
/// times area. Each candidate is a pure function of the seed, its face and its attempt number. The density is
/// first sampled on a grid per ptex face, so that few candidates are rejected where the density is low.
/// Features of a map that are thinner than a 32nd of a face may therefore get too few candidates. The surface
/// and the density must outlive this object.
class FollicleCandidates {
 public:
  /// `measure`: measure_surface() of the same surface and density. `wanted`: expected number of candidates.
  /// Throws the errors of want().
  FollicleCandidates(const LimitSurface& rest, const FollicleDensity& density, uint64_t seed, size_t wanted,
                     SurfaceMeasure measure);
  /// Sets the expected number of candidates. Throws Error (kInput) if the density is so uneven that too many
  /// attempts would be needed.
  void want(size_t wanted);

  /// Makes the candidates of a share, in order of their random numbers. All shares together have about
  /// `wanted` candidates; the exact number depends on the seed.
  std::vector<FollicleCandidate> make(const Job& job, const CandidateShare& share = {}) const;
  /// Makes all candidates, in no particular order. Sets FollicleCandidate::number of each to its rank in
  /// order of the random numbers. Faster than make().
  std::vector<FollicleCandidate> make_ranked(const Job& job) const;
  /// Computes the survey of all candidates that make() returns, without keeping them in memory.
  CandidateSurvey survey(const Job& job) const;
  /// Returns the max number of candidates to expect when `wanted` are requested.
  static constexpr uint64_t max_of(uint64_t wanted) { return wanted + wanted / 64 + 1024; }
  /// Approximate number of candidates that make() returns for the full range.
  size_t wanted() const { return wanted_; }
  /// Returns the root of the candidate that attempt `attempt` made. Sets `position` to the position of the
  /// root.
  RootAddress root(uint32_t attempt, V3f* position) const;

 private:
  /// Runs the attempts [begin, end). Calls visit(candidate) for each candidate that is accepted and in the
  /// share.
  template <class Visit>
  void try_all(uint64_t begin, uint64_t end, const CandidateShare& share, const Visit& visit) const;
  /// As make(), but in order of attempts.
  std::vector<FollicleCandidate> make_by_attempt(const Job& job, const CandidateShare& share) const;
  size_t face_of(uint64_t attempt) const;
  uint64_t stream(size_t face, uint64_t attempt) const;
  uint64_t order_key(uint64_t attempt) const;
  bool precedes(uint64_t attempt, uint64_t other) const;

  const LimitSurface& rest_;
  const FollicleDensity& density_;
  const uint64_t seed_;
  size_t wanted_ = 0;
  // margin: factor on the largest sampled density, because values between samples may be larger
  const float room_;
  const SurfaceMeasure measure_;
  std::vector<uint64_t> first_;  // first attempt of each face, then the total number of attempts
};

/// Packs a unit vector into 3 x 10 bits, with an error of a thousandth.
uint32_t pack_normal(const V3f& normal);
V3f unpack_normal(uint32_t packed);

/// Makes the candidates of a source in order of their random numbers, part by part. A part is a range of
/// these numbers. Keeps no candidates that next() has returned. With more than one part, makes every
/// candidate twice: first for the survey, then for next(). The source must outlive this object.
class CandidateSupply {
 public:
  /// `parts`: number of parts, of about the same size. It changes neither the candidates nor their order.
  CandidateSupply(const FollicleCandidates& source, size_t parts, const Job& job);

  const CandidateSurvey& survey() const { return survey_; }
  /// Number of candidates that next() has returned so far.
  size_t supplied() const { return supplied_; }
  /// Whether next() has returned all parts.
  bool ended() const { return part_ == parts_; }
  /// Returns the candidates of the next part. Sets FollicleCandidate::number of each to its rank among all
  /// candidates.
  std::vector<FollicleCandidate> next(const Job& job);
  /// Returns all candidates at once, in no particular order. For use instead of next(), if there is one part.
  std::vector<FollicleCandidate> take_all();

 private:
  const FollicleCandidates& source_;
  size_t parts_, part_ = 0, supplied_ = 0;
  // if there is only one part: all candidates with their ranks, until next() or take_all() returns them
  std::vector<FollicleCandidate> all_;
  CandidateSurvey survey_;
};

}  // namespace pelage
