// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/fit_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "base/hash.h"
#include "base/parallel.h"
#include "procedurals/detail/parallel_rays.h"
#include "procedurals/detail/pilot_patch.h"
#include "procedurals/detail/spread_follicles.h"
#include "procedurals/skin/rest_pose.h"

namespace pelage {
namespace {

constexpr size_t kPatches = 16, kDirections = 8, kPerStrand = 2;
constexpr float kStrandsAround = 4000;  // of a pilot root, on average
constexpr size_t kBins = 512;
constexpr float kWidest = 2;       // largest factor
constexpr int64_t kFewest = 1000;  // weight of rays that pass, and of rays that do not
constexpr float kSteepest = 0.6f;  // WidthFit
constexpr uint64_t kUse = random_use("width pilot");

/// Sums of the weights of rays at one share.
struct Tally {
  int64_t live = 0, pass = 0;  // not blocked near their origin; and not blocked at all
  /// By the smallest factor that blocks them; the last bin: none.
  std::array<int64_t, kBins + 1> blocked_from{};

  Tally& operator+=(const Tally& other) {
    live += other.live;
    pass += other.pass;
    for (size_t bin = 0; bin <= kBins; ++bin) blocked_from[bin] += other.blocked_from[bin];
    return *this;
  }
};
/// At the shares of WidthFit.
using Tallies = std::array<Tally, WidthFit::kQuarterings + 1>;

V3f direction_of(size_t patch, size_t index) {
  // Evenly spread over the sphere, turned at random.
  const double z = 1 - (2 * static_cast<double>(index) + 1) / kDirections;
  const double turn = unit_float(hash64(patch, kUse));
  const double phi = 2 * std::numbers::pi * (turn + static_cast<double>(index) * (std::numbers::phi - 1));
  const double r = std::sqrt(1 - z * z);
  return V3f(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
             static_cast<float>(z));
}

/// A place on a strand from which rays start.
struct Origin {
  V3f position;
  uint32_t strand;  // in the patch
};

std::vector<Origin> origins_of(const PilotPatch& patch) {
  std::vector<Origin> origins;
  for (uint32_t s = 0; s < patch.strands.size(); ++s) {
    const PilotPatch::Strand& strand = patch.strands[s];
    for (uint64_t k = 0; strand.starts && k < kPerStrand; ++k) {
      const float at = unit_float(hash64(strand.id, k, kUse)) * static_cast<float>(strand.end - strand.begin);
      const auto piece = std::min(static_cast<uint32_t>(at), strand.end - strand.begin - 1);
      const StrandPiece& on = patch.pieces[strand.begin + piece];
      origins.push_back({on.begin + (at - static_cast<float>(piece)) * (on.end - on.begin), s});
    }
  }
  return origins;
}

/// The rays of one direction.
class Pilots {
 public:
  Pilots(const PilotPatch& patch, std::span<const Origin> origins, const V3f& direction) : patch_(patch) {
    std::vector<V3f> from;
    for (uint32_t o = 0; o < origins.size(); ++o) {
      if (!(patch.strands[origins[o].strand].up.dot(direction) > 0)) continue;
      from.push_back(origins[o].position);
      origin_.push_back(o);
      own_.push_back(origins[o].strand);
    }
    rays_.emplace(direction, from);
    meet_all();
  }

  /// Bytes of memory of this object, and of count().
  size_t bytes() const {
    constexpr size_t kPerRay = 2 * sizeof(uint32_t) + 3 * sizeof(float);
    return sizeof(*this) + rays_->bytes() + own_.capacity() * kPerRay +
           passes_.capacity() * sizeof(ParallelRays::Pass);
  }

  /// Counts the origins from which nothing blocks the ray.
  void count_open(std::vector<int32_t>& open, int32_t sign) const {
    for (size_t ray = 0; ray < own_.size(); ++ray) open[origin_[ray]] += is_open(ray) ? sign : 0;
  }

  /// `weights`: by origin.
  void count(const Simplification& seen, float share, float near, std::span<const int32_t> weights,
             Tally& tally) {
    std::vector<float> from(own_.size(), kWidest);
    for (const PilotPatch::Strand& strand : patch_.strands) {
      const float width = seen.width_factor(share, strand.priority);
      if (!(width > 0)) continue;
      for (uint32_t p = strand.begin; p < strand.end; ++p) {
        passes_.clear();
        StrandPiece piece = patch_.pieces[p];
        piece.begin_radius *= width;
        piece.end_radius *= width;
        rays_->meet(piece, kWidest, passes_);
        for (const auto& [ray, distance, across] : passes_) {
          if (distance >= near) from[ray] = std::min(from[ray], across);
        }
      }
    }
    for (size_t ray = 0; ray < from.size(); ++ray) {
      if (nearest_[ray] < near) continue;
      const int64_t weight = weights[origin_[ray]];
      tally.live += weight;
      if (farthest_[ray] < near) tally.pass += weight;
      tally.blocked_from[static_cast<size_t>(from[ray] * (kBins / kWidest))] += weight;
    }
  }

 private:
  bool is_open(size_t ray) const { return nearest_[ray] == std::numeric_limits<float>::infinity(); }

  void meet_all() {
    nearest_.assign(own_.size(), std::numeric_limits<float>::infinity());
    farthest_.assign(own_.size(), 0);
    for (const StrandPiece& piece : patch_.pieces) {
      passes_.clear();
      rays_->meet(piece, 1, passes_);
      for (const auto& [ray, distance, across] : passes_) {
        farthest_[ray] = std::max(farthest_[ray], distance);
        if (distance > 0 && piece.strand != own_[ray]) nearest_[ray] = std::min(nearest_[ray], distance);
      }
    }
  }

  const PilotPatch& patch_;
  std::vector<uint32_t> origin_, own_;  // by ray: index of its origin, and its strand
  std::optional<ParallelRays> rays_;
  std::vector<float> nearest_, farthest_;  // by ray: distances of hits; the nearest is not on its own strand
  std::vector<ParallelRays::Pass> passes_;
};

/// Charges what it holds to MemoryTag::kGrooms.
Tallies count_patch(const PilotPatch& patch, size_t number, const Simplification& seen, float spacing,
                    MemoryLedger& ledger) {
  const std::vector<Origin> origins = origins_of(patch);
  std::vector<Pilots> pilots;
  std::vector<int32_t> weights(origins.size(), 0);
  for (size_t d = 0; d < kDirections; ++d) {
    pilots.emplace_back(patch, origins, direction_of(number, d));
    pilots.back().count_open(weights, 1);
  }
  size_t bytes = patch.bytes() + origins.capacity() * sizeof(Origin) + weights.capacity() * sizeof(int32_t);
  for (const Pilots& of_direction : pilots) bytes += of_direction.bytes();
  const MemoryCharge charge(ledger, MemoryTag::kGrooms, static_cast<int64_t>(bytes));
  Tallies tallies;
  for (Pilots& of_direction : pilots) {
    // Whether a ray is open must not decide how much it counts.
    of_direction.count_open(weights, -1);
    for (size_t i = 1; i < tallies.size(); ++i) {
      const float share = std::ldexp(1.0f, -2 * static_cast<int>(i));
      of_direction.count(seen, share, near_distance(share, spacing), weights, tallies[i]);
    }
    of_direction.count_open(weights, 1);
  }
  return tallies;
}

/// The factor that blocks all but the rays that pass.
float factor(const Tally& tally) {
  int64_t passing = tally.blocked_from[kBins];
  size_t bin = kBins;
  while (bin > 0 && passing + tally.blocked_from[bin - 1] <= tally.pass) passing += tally.blocked_from[--bin];
  return kWidest * static_cast<float>(bin) / kBins;
}

}  // namespace

float near_distance(float share, float spacing) { return 2 * spacing / std::sqrt(share); }

std::optional<WidthFit> fit_coverage(const Groom& groom, const LimitSurface* rest,
                                     const EvenPriorities* priorities, const Simplification& seen,
                                     float spacing, const Job& job) {
  const RestPose pose(groom, rest, job.workers);
  const float radius = spacing * std::sqrt(kStrandsAround / std::numbers::pi_v<float>);
  const std::vector<size_t> roots = spread_follicles(groom, kPatches);
  std::vector<Tallies> of_patch(roots.size());
  job.for_each(roots.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i)
      of_patch[i] = count_patch(strands_around(groom, pose, priorities, roots[i], radius, job), i, seen,
                                spacing, job.ledger);
  });
  Tallies sum;
  for (const Tallies& tallies : of_patch) {
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += tallies[i];
  }
  WidthFit fit;
  for (size_t h = 1; h < fit.factors.size(); ++h) {
    const float previous = fit.factors[h - 1];
    const bool knows = sum[h].pass >= kFewest && sum[h].live - sum[h].pass >= kFewest;
    if (!knows && h == 1) return {};
    fit.factors[h] = knows ? std::max(factor(sum[h]), kSteepest * previous) : previous;
  }
  return fit;
}

}  // namespace pelage
