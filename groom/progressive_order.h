// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "groom/candidate_supply.h"

namespace pelage {

struct Job;

/// Candidates tried per follicle. More candidates pack the last follicles more tightly, at proportional cost.
inline constexpr size_t kCandidatesPerFollicle = 6;

/// How many candidates are in memory at a time.
struct HeldCandidates {
  size_t parts = 1;        ///< they are made in, see CandidateSupply
  size_t max_waiting = 0;  ///< of those that wait to be tried (again)

  /// All, of so many: what no choice can fail for.
  static HeldCandidates all(size_t candidates) { return {1, candidates}; }
  /// What does for `count` follicles on almost any skin.
  static HeldCandidates of(size_t candidates, size_t count);
};

/// Chooses `count` candidates in an order of which every prefix is blue noise: progressive dart throwing, in
/// which the forbidden radius shrinks slowly and each radius is tried on all candidates before the next
/// [McCool92, section 4]. Two follicles stand at least the radius times the smaller of their spacings apart,
/// by Euclidean distance; those whose normals differ by more than 60 degrees ignore each other.
///
/// Differs from the paper in cost: a rejected candidate waits until the radius has shrunk to its distance
/// from the nearest follicle, and candidates join in proportion to the follicles placed so far, so that each
/// is examined only a few times: O(N log N). `area`: of the surface scaled to spacing 1 (the integral of the
/// density); used only to estimate the number of follicles at a radius.
///
/// Returns attempts of candidates; fewer than `count` when there are fewer candidates. Where not all fit into
/// `held`, those are forgotten that the follicles placed so far keep away to the end: the order is the same,
/// bit by bit. How far the radius shrinks to the end is known by then, because follicles grow as 1 / radius^2
/// in number; where they do not (a skin that is narrower than their distance), candidates that were forgotten
/// may be missed, and there is no result. Parallel in the making of candidates only; throws Error (kStopped).
std::optional<std::vector<uint32_t>> progressive_order(CandidateSupply& supply, size_t count, double area,
                                                       const HeldCandidates& held, const Job& job);

/// Upper bound of the memory in use at any moment while `count` follicles are made from `candidates`.
size_t progressive_order_bytes(size_t candidates, size_t count, const HeldCandidates& held);

}  // namespace pelage
