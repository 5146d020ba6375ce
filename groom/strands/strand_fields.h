// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "groom/strands/strand_batch.h"
#include "image/field.h"

namespace pelage {

// Evaluation of operator fields over a batch. Fields may read these attributes:
//   random  a number in [0, 1) per strand
//   clump   a number in [0, 1) per clump, or per strand without a clump (set by the operator clump)
//   color   the colour of the strand as set by the operators so far, initially 1

/// Evaluates the first channel of a field for each strand, at position `along` (0 root, 1 tip). The attribute
/// "color" is the colour at point 0.
void evaluate(const Field& field, const StrandBatch& batch, float along, StrandRow& out);
/// Evaluates all three channels of a field for each strand at point `point`. The attribute "color" is the
/// colour at this point.
void evaluate_color(const Field& field, const StrandBatch& batch, int point, VectorRow& out);

/// Evaluates a field over a batch at successive positions along the strands. A field may be a product; each
/// factor is evaluated separately. A factor that does not change along strands is evaluated once per strand.
/// A factor that changes only along strands is evaluated once per position.
class StrandField {
 public:
  StrandField(const Field& field, const StrandBatch& batch) : factors_(field, batch), batch_(batch) {}
  /// Returns the values at position `along` of the strands. The next call overwrites the returned row.
  const StrandRow& at(float along);

 private:
  friend class StrandColor;
  template <class Row>
  struct Factor {
    const Field& field;
    bool changes_along, changes_by_strand;
    Row fixed;  // values of a factor that does not change along strands
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

/// Evaluates all three channels of a field over a batch, at successive points. Otherwise like StrandField.
class StrandColor {
 public:
  StrandColor(const Field& field, const StrandBatch& batch) : factors_(field, batch), batch_(batch) {}
  void at(int point, VectorRow& out);

 private:
  StrandField::Factors<VectorRow> factors_;
  const StrandBatch& batch_;
};

}  // namespace pelage
