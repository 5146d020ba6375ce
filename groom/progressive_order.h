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
  size_t parts = 1;        ///< number of parts in which candidates are made, see CandidateSupply
  size_t max_waiting = 0;  ///< max number of candidates that wait to be tried, or tried again

  /// All candidates at once: the choice never fails.
  static HeldCandidates all(size_t candidates) { return {1, candidates}; }
  /// As few candidates as suffice for `count` follicles on almost any skin.
  static HeldCandidates least(size_t candidates, size_t count);
  /// all() for up to two million candidates, which takes the least time; least() for more.
  static HeldCandidates fastest(size_t candidates, size_t count);
};

/// Chooses `count` candidates and orders them so that every prefix of the order is blue noise. The method is
/// progressive dart throwing: the forbidden radius shrinks slowly, and each radius is tried on all candidates
/// before the next radius [McCool92, section 4]. The Euclidean distance between two follicles is at least the
/// radius times the smaller of their spacings; follicles whose normals differ by more than 60 degrees ignore
/// each other.
///
/// The cost is lower than in the paper, O(N log N), because each candidate is examined only a few times. A
/// rejected candidate waits until the radius has shrunk to its distance from the nearest follicle, and new
/// candidates are added in proportion to the follicles placed so far. `area`: of the surface scaled to
/// spacing 1 (the integral of the density); used only to estimate the number of follicles at a radius.
///
/// Returns FollicleCandidate::attempt of each chosen candidate; fewer than `count` when there are fewer
/// candidates. When `held` has no room for all candidates, drops candidates that the follicles placed so far
/// would reject even at the final radius. This does not change the result by a bit. The final radius is
/// predicted from the number of follicles, which grows as 1 / radius^2. On a skin that is narrower than the
/// distance between follicles, the prediction may be wrong and dropped candidates may be needed; the result
/// is then empty. Only the making of candidates is parallel. Throws Error (kStopped) when the job is stopped.
std::optional<std::vector<uint32_t>> progressive_order(CandidateSupply& supply, size_t count, double area,
                                                       const HeldCandidates& held, const Job& job);

/// Upper bound of the memory in use at any moment while `count` follicles are made from `candidates`.
size_t progressive_order_bytes(size_t candidates, size_t count, const HeldCandidates& held);

}  // namespace pelage
