// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/ledger.h"
#include "base/schema.h"
#include "base/value_readers.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `part`. One of `points` and `file` is given.
struct PartingParams {
  std::vector<V3f> points;
  AssetPath file;
  std::optional<float> width;
  Field lift{0.2f};
  Field amount{1.0f};
  float curve = 0;
  static const Schema<PartingParams>& schema();
};

/// Turns strands away from a line on the rest skin, so that hair falls both ways. Preserves the length of
/// every segment. Wherever the operator stands in its groom, guides and clumps do not act across the line.
///
/// The turn is complete up to half the width from the line and falls to 0 at the width. Beyond an end of the
/// line, it fades with the angle to the direction of the line.
class Parting final : public OperatorOf<PartingParams> {
 public:
  static constexpr const char* kName = "part";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName, .parts_hair = true}; }
  /// Throws Error (kInput) for lines without extent, for too many segments, and for skins whose faces are all
  /// holes. Warns of points that are far from the skin.
  void prepare(const PrepareContext& context) override;
  std::shared_ptr<const PartLines> part() const override { return lines_; }
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  float width_ = 0;
  std::shared_ptr<const PartLines> lines_;
  std::shared_ptr<const MemoryCharge> charge_;
};

}  // namespace pelage
