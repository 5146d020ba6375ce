// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "groom/strand_batch.h"
#include "image/field.h"

namespace pelage {

// Evaluation of operator fields over a batch. Fields may read the attributes
//   random  a number in [0, 1) per strand,
//   clump   the same for all strands of a clump (set by the operator clump),
//   color   the strand's colour so far (1 before any operator has set it).

/// First channel of a field for each strand, at `along` (0 root, 1 tip).
void evaluate(const Field& field, const StrandBatch& batch, float along, StrandRow& out);
/// All three channels; `point`: the point whose colour the attribute "color" returns.
void evaluate_color(const Field& field, const StrandBatch& batch, int point, VectorRow& out);

/// Evaluates a field over a batch at successive positions along the strands. A factor of a product (and any
/// other field) that does not change along strands is evaluated once per strand; a factor that changes only
/// along strands is evaluated once per position.
class StrandField {
 public:
  StrandField(const Field& field, const StrandBatch& batch) : factors_(field, batch), batch_(batch) {}
  /// Values at a position along the strands. The row is overwritten by the next call.
  const StrandRow& at(float along);

 private:
  friend class StrandColor;
  template <class Row>
  struct Factor {
    const Field& field;
    bool changes_along, changes_by_strand;
    Row fixed;  // of those that do not change along strands
  };
  template <class Row>
  struct Factors {
    Factors(const Field& field, const StrandBatch& batch);
    std::vector<Factor<Row>> list;
  };
  Factors<StrandRow> factors_;
  const StrandBatch& batch_;
  StrandRow row_;
};

/// The same for all three channels, by point.
class StrandColor {
 public:
  StrandColor(const Field& field, const StrandBatch& batch) : factors_(field, batch), batch_(batch) {}
  void at(int point, VectorRow& out);

 private:
  StrandField::Factors<VectorRow> factors_;
  const StrandBatch& batch_;
};

}  // namespace pelage
