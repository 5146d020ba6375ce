// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "groom/coat/groom_params.h"
#include "groom/operators/operator_stack.h"

namespace pelage {

class FieldSkin;

/// Versions of the steps of growth that are not operators; the version of an operator is one of its traits.
///
/// Cached strands are found by these versions, so a change of the code leaves caches valid unless it raises
/// one. Raise the version of the first step that now gives other results, if only in the last digit.
/// tests/groom/cache/growth_versions_test.cpp fails when results change and no version does.
namespace growth_version {
inline constexpr int kSkin = 2;     ///< limit surfaces and their frames (geom/)
inline constexpr int kFields = 2;   ///< maps, ramps and noise (image/)
inline constexpr int kStrands = 2;  ///< places of follicles; strands of a file and their roots
inline constexpr int kPoints = 1;   ///< strands before the first operator
inline constexpr int kFrozen = 1;   ///< rounding of frozen strands (groom/cache/strand_codes.h)
inline constexpr int kPose = 1;     ///< finished strands in a pose (Groom::grow())
}  // namespace growth_version

/// One step of making a coat. Lists all its inputs as readable text, so that a change can be shown to the
/// user.
struct GroomStage {
  std::string name;  ///< "skin", "strands", "points", or the name of an operator
  /// Name and value of each: "amount", "0.6". "version" is the version of the code that runs the stage.
  std::vector<std::pair<std::string, std::string>> inputs;
  ContentHash hash;  ///< hash of this stage and of all stages before it
};

/// The inputs of a groom's strands, stage by stage: skin, strands, points, then each operator. Equal hashes
/// mean equal strands. Files are identified by their contents, not by their paths.
class GroomIdentity {
 public:
  static constexpr size_t kSkin = 0, kStrands = 1, kPoints = 2, kFirstOperator = 3;

  /// `seed`: hash of the groom's seed and name. A file that cannot be read is recorded as such without an
  /// error; the code that needs the file reports the error.
  /// `skin`: what fields read from the mesh of the skin; may be null.
  GroomIdentity(const GroomParams& params, uint64_t seed, const OperatorStack& stack,
                const LimitSurface* rest, const FieldSkin* skin = nullptr);

  const std::vector<GroomStage>& stages() const { return stages_; }
  const GroomStage& of_operator(size_t i) const { return stages_[kFirstOperator + i]; }
  /// Hash of the whole groom: the hash of its last stage.
  const ContentHash& whole() const { return stages_.back().hash; }

 private:
  void add(std::string name, int version, const std::vector<ParameterText>& parameters);

  std::vector<GroomStage> stages_;
  const FieldSkin* skin_;
};

}  // namespace pelage
