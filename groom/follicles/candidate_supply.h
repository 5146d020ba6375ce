// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "groom/follicles/follicle_candidates.h"

namespace pelage {

/// Makes the candidates of a source in order of their random numbers, part by part. A part is a range of
/// these numbers. Keeps no candidates that next() has returned. With more than one part, makes every
/// candidate twice: first for the survey, then for next(). The source must outlive this object.
class CandidateSupply {
 public:
  /// `parts`: number of parts, of about the same size. It changes neither the candidates nor their order.
  CandidateSupply(const FollicleCandidates& source, size_t parts, const Job& job);

  const CandidateSurvey& survey() const { return survey_; }
  /// Number of candidates that next() has returned so far.
  size_t supplied() const { return supplied_; }
  /// Whether next() has returned all parts.
  bool ended() const { return part_ == parts_; }
  /// Returns the candidates of the next part. Sets FollicleCandidate::number of each to its rank among all
  /// candidates.
  std::vector<FollicleCandidate> next(const Job& job);

 private:
  const FollicleCandidates& source_;
  size_t parts_, part_ = 0, supplied_ = 0;
  // if there is only one part: all candidates, until next() returns them
  std::vector<FollicleCandidate> all_;
  CandidateSurvey survey_;
};

}  // namespace pelage
