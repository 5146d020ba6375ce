// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "groom/groom_params.h"
#include "groom/operator_stack.h"

namespace pelage {

/// One step in the making of a coat, with all its inputs as readable text, so that a change can be shown to
/// the user.
struct GroomStage {
  std::string name;  ///< "skin", "strands", "points", or the name of an operator
  std::vector<std::pair<std::string, std::string>> inputs;  ///< "amount", "0.6"
  ContentHash hash;                                         ///< hash of this stage and of all stages before
                                                            ///< it
};

/// The inputs of a groom's strands, step by step: skin, strands, points, then each operator. Equal hashes
/// mean equal strands. Files are identified by their contents, whatever their folder.
class GroomIdentity {
 public:
  static constexpr size_t kSkin = 0, kStrands = 1, kPoints = 2, kFirstOperator = 3;

  /// `seed`: the groom's seed with its name mixed in. Unreadable files are recorded as unreadable; the code
  /// that needs them reports the error.
  GroomIdentity(const GroomParams& params, uint64_t seed, const OperatorStack& stack,
                const LimitSurface* rest);

  const std::vector<GroomStage>& stages() const { return stages_; }
  const GroomStage& of_operator(size_t i) const { return stages_[kFirstOperator + i]; }
  /// Hash of all operators.
  const ContentHash& whole() const { return stages_.back().hash; }

 private:
  void add(std::string name, const std::vector<ParameterText>& parameters);

  std::vector<GroomStage> stages_;
};

}  // namespace pelage
