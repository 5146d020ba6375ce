// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "base/vector.h"

namespace pelage {

class StrandBatch;
struct PrepareContext;

/// Longest possible strand and widest possible radius before or after an operator, for bounds. Scene units.
struct StrandReach {
  float length = 0;  ///< no point lies further than this from its root
  float radius = 0;
};

/// One step of a groom: moves the points of strands, or sets their attributes.
///
/// Contract: pure and deterministic by strand id: what happens to a strand depends on its own points, id and
/// root, the operator's parameters and what prepare() learned from rest state, never on which other strands
/// are in the batch. Roots never move. Thread safety: apply() may run on many batches at once.
class Operator {
 public:
  virtual ~Operator() = default;
  /// As in the scene file: "clump".
  virtual std::string_view name() const = 0;
  /// Rest state only: the offsets serve every pose and may be frozen. Otherwise the operator sees posed
  /// strands.
  virtual bool reads_rest_only() const { return true; }
  /// Reads maps and files, gathers what it needs of the whole coat (clump centres, guides). Called once.
  virtual void prepare(const PrepareContext&) {}
  virtual void apply(StrandBatch& batch) const = 0;
  /// Bound on how far apply() moves any point of a strand that `before` bounds: at most 1.5 times what it
  /// really does to the worst strand.
  virtual float displacement_bound(const StrandReach& before) const = 0;
  /// What holds after apply(); the default adds the displacement.
  virtual StrandReach reach_after(const StrandReach& before) const {
    return {before.length + displacement_bound(before), before.radius};
  }
};

}  // namespace pelage
