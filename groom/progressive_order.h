// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

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
/// Returns indices of candidates; fewer than `count` when there are fewer candidates.
std::vector<uint32_t> progressive_order(std::span<const FollicleCandidate> candidates, size_t count,
                                        double area);

}  // namespace pelage
