// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "groom/follicles/follicles.h"
#include "groom/operators/operator.h"
#include "groom/operators/operator_list.h"
#include "groom/sim/dynamics_params.h"
#include "groom/strands/root_grid.h"

namespace pelage {

/// Guides of a coat with `dynamics`: follicles in the coat's own order of priority. Made once the follicles
/// are known.
struct MovingGuides {
  std::vector<uint32_t> follicles;  ///< indices in the follicle tree, by ascending id
  RootGrid roots;                   ///< rest roots of these follicles
  /// From root to tip, in rest space; only for `mode: kinematic`.
  std::vector<V3f> tips;

  void place(size_t count, const FollicleTree& coat, const LimitSurface& rest);
};

/// Turns each segment of a strand as the guides around it turn (StrandBatch::turns), as `dynamics` of
/// a groom asks. The weight of a guide falls with its distance as for the operator `guides`. Segments keep
/// their lengths. Strands without a guide nearby, and all strands at rest, stay as they are.
class Follow final : public Operator {
 public:
  static constexpr const char* kName = "dynamics";
  Follow(int neighbours, std::shared_ptr<const MovingGuides> guides, std::string count)
      : neighbours_(neighbours), guides_(std::move(guides)), count_(std::move(count)) {}

  OperatorTraits traits() const override { return {.name = kName, .reads_rest_only = false}; }
  std::vector<ParameterText> parameters() const override {
    return {{"guides", count_}, {"neighbours", std::to_string(neighbours_)}};
  }
  void prepare(const PrepareContext& context) override { parts_ = context.parts; }
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  int neighbours_;
  std::shared_ptr<const MovingGuides> guides_;
  std::string count_;
  std::vector<std::shared_ptr<const PartLines>> parts_;
};

/// Returns the index in `list` at which strands move.
size_t follow_place(const DynamicsParams& params, const OperatorList& list);
/// Returns the item of a list that makes strands follow `guides`.
OperatorList::Item follow_item(const DynamicsParams& params, std::shared_ptr<const MovingGuides> guides);

}  // namespace pelage
