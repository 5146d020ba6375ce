// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "groom/cache/frozen_leaf.h"
#include "groom/cache/strand_codes.h"

namespace pelage {

/// Collects the batches of a leaf, which are in rest space after the frozen operators. Writes their codes in
/// the smallest form.
class FrozenLeafWriter {
 public:
  explicit FrozenLeafWriter(const CodeOptions& options = {}) : options_(options) {}
  void add(const StrandBatch& batch) { blocks_.emplace_back(batch, options_); }
  /// Returns the bytes that FrozenLeaf reads. The bytes depend only on the strands and on the byte order of
  /// the machine.
  std::vector<std::byte> finish() const;

 private:
  /// Returns the column in which the codes `kind` are written. Sets `choice`, which owns the column's table.
  CodeColumn column(StrandCodes::Column kind, CodeColumn::Choice& choice) const;

  CodeOptions options_;
  std::vector<StrandCodes> blocks_;
};

}  // namespace pelage
