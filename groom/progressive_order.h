// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

struct Job;

/// Candidates tried per follicle. More candidates pack the last follicles more tightly, at proportional cost.
inline constexpr size_t kCandidatesPerFollicle = 6;

/// Chooses `count` candidates in an order of which every prefix is blue noise, by progressive dart throwing:
/// the exclusion radius shrinks slowly, and all candidates are tried at each radius before the next
/// [McCool92, section 4]. The Euclidean distance of two follicles is at least the radius times the smaller of
/// their spacings; those whose normals differ by more than 60 degrees ignore each other.
///
/// Differs from the paper in cost: a rejected candidate waits until the radius has shrunk to its distance
/// from the nearest follicle, and candidates join in proportion to the follicles placed so far, so that each
/// is examined only a few times: O(N log N). `area`: of the surface scaled to spacing 1 (the integral of the
/// density); used only to estimate the number of follicles at a radius.
///
/// Returns indices of candidates; fewer than `count` when there are fewer candidates. Overwrites
/// FollicleCandidate::next. Sequential; throws Error (kStopped).
std::vector<uint32_t> progressive_order(std::span<FollicleCandidate> candidates, size_t count, double area,
                                        const Job& job);

/// Upper bound of the memory in use at any moment while `count` follicles are made from `candidates`.
size_t progressive_order_bytes(size_t candidates, size_t count);

}  // namespace pelage
