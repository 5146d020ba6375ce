// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "groom/frozen_leaf.h"
#include "groom/strand_codes.h"

namespace pelage {

/// Collects the batches of a leaf, in rest space after the frozen operators, and writes their codes in the
/// smallest form.
class FrozenLeafWriter {
 public:
  explicit FrozenLeafWriter(const CodeOptions& options = {}) : options_(options) {}
  void add(const StrandBatch& batch) { blocks_.emplace_back(batch, options_); }
  /// The bytes that FrozenLeaf reads. The same strands give the same bytes on all machines with the same byte
  /// order.
  std::vector<std::byte> finish() const;

 private:
  /// The column in which `kind` is written; `choice` owns its table.
  CodeColumn column(StrandCodes::Column kind, CodeColumn::Choice& choice) const;

  CodeOptions options_;
  std::vector<StrandCodes> blocks_;
};

}  // namespace pelage
