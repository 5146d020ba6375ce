// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "groom/follicles/follicle_candidates.h"

namespace pelage {

struct Job;

/// The fast way to run progressive_order() when all candidates are in memory, with the same result.
/// Candidates are sorted into blocks of neighbours. Each block lists the follicles in its vicinity
/// (CandidateBlocks), so that testing a candidate needs no search. Threads test blocks in parallel. Each
/// candidate knows the level at which it is tried next: first the level at which it joins, later the level
/// that reaches its distance from the nearest follicle.
///
/// `candidates`: all candidates; FollicleCandidate::number is their rank. Returns no order when the lists
/// would need more memory than block_order_bytes().
std::optional<std::vector<uint32_t>> block_order(std::vector<FollicleCandidate> candidates,
                                                 const CandidateSurvey& survey, size_t count, double area,
                                                 const Job& job);

/// Returns an upper bound of the memory in use at any moment, candidates included.
size_t block_order_bytes(size_t candidates, size_t count);

}  // namespace pelage
