// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

struct Job;

/// Candidates that are tried per follicle wanted. More pack the last follicles tighter, at proportional cost.
inline constexpr size_t kCandidatesPerFollicle = 6;

/// Chooses `count` candidates in an order of which every prefix is blue noise: progressive dart throwing, in
/// which the forbidden radius shrinks slowly and each radius is tried on all candidates before the next
/// [McCool92, section 4]. Two follicles stand at least the radius times the smaller of their spacings apart,
/// by Euclidean distance; those whose normals differ by more than 60 degrees ignore each other.
///
/// Deviates from the paper in cost: a rejected candidate waits until the radius has shrunk to its distance
/// from the nearest follicle, and candidates join in proportion to the follicles placed so far, so that each
/// is looked at a few times in all: O(N log N). `area` is that of the surface where the spacing is 1 (the
/// integral of the density); it only says how many follicles to expect of a radius.
///
/// Returns indices of candidates; fewer than `count` when there are fewer candidates. Overwrites
/// FollicleCandidate::next. Sequential; throws Error (kStopped).
std::vector<uint32_t> progressive_order(std::span<FollicleCandidate> candidates, size_t count, double area,
                                        const Job& job);

/// Upper bound of the bytes that making `count` follicles from `candidates` takes at any moment.
size_t progressive_order_bytes(size_t candidates, size_t count);

}  // namespace pelage
