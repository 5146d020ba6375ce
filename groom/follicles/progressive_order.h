// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "groom/follicles/follicle_candidates.h"

namespace pelage {

struct Job;

/// Limits of the candidates that are in memory at a time.
struct HeldCandidates {
  size_t parts = 1;        ///< number of parts in which candidates are made (CandidateSupply)
  size_t max_waiting = 0;  ///< max number of candidates that wait for their next test
  /// Whether candidates are tried in blocks (block_order.h), which is faster. Requires one part, and room for
  /// all candidates.
  bool in_blocks = false;

  /// Holds all candidates at once, in blocks.
  static HeldCandidates all(size_t candidates) { return {1, candidates, true}; }
  /// Holds as few candidates as suffice to choose `count` follicles on almost any skin.
  static HeldCandidates least(size_t candidates, size_t count);
  /// Returns the fastest limits: all() for up to two million candidates, least() for more.
  static HeldCandidates fastest(size_t candidates, size_t count);
};

/// Chooses `count` candidates and orders them so that every prefix of the order is blue noise. The method is
/// progressive dart throwing [McCool92, section 4]: the forbidden radius shrinks in small steps, and all
/// candidates are tried at each radius. The Euclidean distance between two chosen candidates is at least the
/// radius times the smaller of their spacings. Candidates whose normals differ by more than 60 degrees ignore
/// each other.
///
/// The cost is O(N log N), lower than in the paper, because each candidate is tested only a few times. A
/// rejected candidate waits until the radius has shrunk to its distance from the nearest follicle. New
/// candidates are added in proportion to the follicles chosen so far. `area`: area of the surface scaled to
/// spacing 1, which is the integral of the density. It is used only to estimate the number of follicles at a
/// radius.
///
/// Returns FollicleCandidate::attempt of each chosen candidate. Returns fewer than `count` when there are
/// fewer candidates.
///
/// When `held` has no room for all candidates, drops candidates that the follicles chosen so far would reject
/// even at the final radius. Dropping them does not change the result. The final radius is predicted from the
/// number of follicles, which grows as 1 / radius^2. On a skin that is narrower than the distance between
/// follicles, this prediction may be wrong, and dropped candidates may be needed. The result is then empty.
/// The result is also empty when blocks of candidates would need more memory than progressive_order_bytes(),
/// for example if the density has such steep steps that many blocks meet the same follicles. It is never
/// empty for {parts, number of candidates, false}.
///
/// Making candidates is parallel, and so are the tests against follicles of earlier levels. One thread sorts
/// candidates by rank, and tests the few that pass in order. Throws Error (kStopped) when the job is stopped.
std::optional<std::vector<uint32_t>> progressive_order(CandidateSupply& supply, size_t count, double area,
                                                       const HeldCandidates& held, const Job& job);

/// Returns an upper bound of the memory in use at any moment while `count` follicles are chosen from
/// `candidates`.
size_t progressive_order_bytes(size_t candidates, size_t count, const HeldCandidates& held);

}  // namespace pelage
