// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/candidate_supply.h"

#include <utility>

#include "base/job.h"

namespace pelage {

CandidateSupply::CandidateSupply(const FollicleCandidates& source, size_t parts, const Job& job)
    : source_(source), parts_(parts) {
  if (parts_ > 1) {
    survey_ = source_.survey(job);
    return;
  }
  all_ = source_.make(job);
  for (const FollicleCandidate& candidate : all_) survey_.add(candidate);
  job.progress.advance(1);  // as much as a survey of its own
}

std::vector<FollicleCandidate> CandidateSupply::next(const Job& job) {
  const auto border = [this](size_t part) { return (uint64_t(1) << 32) * part / parts_; };
  std::vector<FollicleCandidate> candidates =
      parts_ == 1 ? std::move(all_) : source_.make(job, {border(part_), border(part_ + 1)});
  ++part_;
  for (FollicleCandidate& candidate : candidates) candidate.number = static_cast<uint32_t>(supplied_++);
  return candidates;
}

}  // namespace pelage
