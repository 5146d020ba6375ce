// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

/// Makes candidates in their order, part by part. Does not keep candidates that it has returned. With more
/// than one part, every candidate is made twice: first for the survey, then for next(). The source must
/// outlive this object.
class CandidateSupply {
 public:
  /// `parts`: number of parts, of about the same size. The candidates are the same for any number of parts.
  CandidateSupply(const FollicleCandidates& source, size_t parts, const Job& job);

  const CandidateSurvey& survey() const { return survey_; }
  /// Number of candidates that next() has returned.
  size_t supplied() const { return supplied_; }
  bool ended() const { return part_ == parts_; }
  /// The candidates of the next part. FollicleCandidate::number is the rank of each.
  std::vector<FollicleCandidate> next(const Job& job);

 private:
  const FollicleCandidates& source_;
  size_t parts_, part_ = 0, supplied_ = 0;
  std::vector<FollicleCandidate> all_;  // all candidates if there is only one part, until next() is called
  CandidateSurvey survey_;
};

}  // namespace pelage
