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

/// Returns whether a field may have several values on one strand: it depends on the position along strands,
/// or on their attribute "color", which may.
bool changes_along(const Field& field);

/// Evaluates a field over a batch at successive positions along the strands. If it is computed from other
/// fields, each of these is evaluated separately. A field that does not change along strands is evaluated
/// once per strand. A field that changes only along strands is evaluated once per position. `Row`: StrandRow
/// for the first channel, VectorRow for all three. The field and the batch must outlive this object.
template <class Row>
class FieldRows {
 public:
  FieldRows(const Field& field, const StrandBatch& batch);
  /// Returns the values at position `along` of the strands, where the attribute "color" is that at `point`.
  /// The next call overwrites the returned row.
  const Row& at(float along, int point);

 private:
  const Field& field_;
  const StrandBatch& batch_;
  bool changes_along_;
  std::vector<FieldRows> inputs_;  // of a field that changes along strands
  Row row_;
};

/// Evaluates the first channel of a field over a batch, at successive positions.
class StrandField {
 public:
  StrandField(const Field& field, const StrandBatch& batch) : rows_(field, batch) {}
  const StrandRow& at(float along) { return rows_.at(along, 0); }

 private:
  FieldRows<StrandRow> rows_;
};

/// Evaluates all three channels of a field over a batch, at successive points.
class StrandColor {
 public:
  StrandColor(const Field& field, const StrandBatch& batch) : rows_(field, batch), batch_(batch) {}
  void at(int point, VectorRow& out) { out = rows_.at(batch_.along(point), point); }

 private:
  FieldRows<VectorRow> rows_;
  const StrandBatch& batch_;
};

}  // namespace pelage
