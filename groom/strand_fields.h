// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/strand_batch.h"
#include "image/field.h"

namespace pelage {

// How operators evaluate their fields over a batch. Fields may ask for the attributes
//   random  a number in [0, 1) of the strand's own,
//   clump   the same for all strands of a clump (set by the operator clump),
//   color   what operators before have coloured the strand (1 before any has).

/// First channel of a field at each strand, at `along` (0 root, 1 tip) of it.
void evaluate(const Field& field, const StrandBatch& batch, float along, StrandRow& out);
/// All three channels; `point` says whose colour the attribute "color" means.
void evaluate_color(const Field& field, const StrandBatch& batch, int point, VectorRow& out);

/// A field over a batch, evaluated once per strand unless it changes along strands.
class StrandField {
 public:
  StrandField(const Field& field, const StrandBatch& batch)
      : field_(field), batch_(batch), along_(field.dependence().along) {
    if (!along_) evaluate(field_, batch_, 0.0f, row_);
  }
  /// Values at a position along the strands. The row is overwritten by the next call.
  const StrandRow& at(float along) {
    if (along_) evaluate(field_, batch_, along, row_);
    return row_;
  }

 private:
  const Field& field_;
  const StrandBatch& batch_;
  bool along_;
  StrandRow row_;
};

}  // namespace pelage
