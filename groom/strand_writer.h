// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/strands.h"
#include "groom/strand_batch.h"

namespace pelage {

/// Collects finished batches into the arrays of a Strands, which it reserves exactly.
class StrandWriter {
 public:
  StrandWriter(size_t strands, size_t motion_keys, std::optional<AttributeClass> colors, bool has_roots);

  /// Point count of the next strand, before anything is written / of all strands.
  void expect(int points);
  void expect_all(int points);
  /// Rows of colour that batches of strands with `points` points must carry.
  size_t color_rows(int points) const;

  /// Writes a batch whose strands come from number `first` on, scaled by `length` about their roots, widths
  /// apart; colours with key 0.
  void write(const StrandBatch& batch, size_t first, size_t key, float length);
  void write_root(const StrandBatch& batch, size_t first, size_t strand, const RootAddress& root);
  StrandArrays take();

 private:
  void write_colors(const StrandBatch& batch, size_t first);

  size_t keys_;
  std::optional<AttributeClass> colors_;
  bool has_roots_;
  StrandArrays arrays_;
};

}  // namespace pelage
