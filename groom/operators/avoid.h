// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/schema.h"
#include "base/value_readers.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `avoid`.
struct AvoidParams {
  AssetPath mesh;
  Field offset{0.0f};
  int iterations = 4;
  static const Schema<AvoidParams>& schema();
};

/// Moves strands out of a closed mesh in the rest space of the skin, such as a collar. Works on strands as
/// they are at rest, so the result is the same in every pose. PushedStrand says what holds afterwards.
class Avoid final : public OperatorOf<AvoidParams> {
 public:
  static constexpr const char* kName = "avoid";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  /// Throws Error (kInput) for a mesh that cannot be read.
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  struct Obstacle;
  std::shared_ptr<const Obstacle> obstacle_;
};

}  // namespace pelage
