// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "groom/operators/operator.h"
#include "groom/strands/strand_batch.h"
#include "image/field.h"

namespace pelage {

class ClumpCentres;

/// How the plies of a clump run around its centre strand.
enum class BraidStyle { kBraid, kTwist };

/// Keys of the operator `braid`.
struct BraidParams {
  BraidStyle style = BraidStyle::kBraid;
  float spacing = 0.5f;
  int plies = 3;
  Field radius{0.06f};
  float pitch = 0.4f;
  float start = 0.15f;
  float thickness = 0.3f;
  Field amount{1.0f};
  static const Schema<BraidParams>& schema();
};

/// Gathers each clump of strands into plies that twist or braid around the centre strand of the clump, which
/// the operators before this one grow. A strand belongs to the ply that is nearest to the direction from the
/// centre's root to its own root. A strand that pulling makes longer is scaled back about its root.
///
/// The plies of a twist run on a helix; those of a braid on the curve (cos t, sin(2 t) / 2) across the centre
/// strand, evenly shifted in t. A centre strand does not count on the other side of a line of the operator
/// `part`.
class Braid final : public OperatorOf<BraidParams> {
 public:
  static constexpr const char* kName = "braid";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName, .runs_preceding = true}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  struct Centre;  // what a strand knows of its centre strand
  V3f target(const Centre& centre, float arc, float radius, int& segment) const;

  uint64_t seed_ = 0;
  std::shared_ptr<const ClumpCentres> centres_;
  std::vector<std::shared_ptr<const PartLines>> parts_;
};

template <>
struct EnumNames<BraidStyle> {
  static constexpr const char* names[] = {"braid", "twist"};
};

}  // namespace pelage
