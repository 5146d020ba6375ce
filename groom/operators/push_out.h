// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `push_out`.
struct PushOutParams {
  Field offset{0.0f};
  int iterations = 4;
  static const Schema<PushOutParams>& schema();
};

/// Moves strands out of the posed skin. Reads live state: runs in every pose, on the same tessellation that
/// is rendered.
///
/// Afterwards, no point of a strand's curve lies inside a closed skin. Control points keep a min distance
/// from the skin, which grows from 0 at the root to `offset`. Segments keep their lengths as far as possible.
/// If a strand cannot be moved out, it is shortened: it ends at the last point of its curve outside the skin.
class PushOut final : public OperatorOf<PushOutParams> {
 public:
  static constexpr const char* kName = "push_out";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override {
    return {.name = kName,
            .reads_rest_only = false,
            .needs_closest_point = true,
            .rest_use = pelage::rest_use(params_.offset.dependence())};
  }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;
};

}  // namespace pelage
