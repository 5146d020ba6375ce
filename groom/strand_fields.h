// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

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

/// A field over a batch at one place of the strands after the other: a factor of a product (and any other
/// field) that does not change along strands is evaluated once per strand, one that changes along them alone
/// once per place.
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
