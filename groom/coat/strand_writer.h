// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/strands.h"
#include "groom/follicles/follicles.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// Collects the strands of finished batches in arrays for Strands. Reserves exactly the memory that the
/// arrays need. Writes either all strands, or chosen strands with modified widths and colours.
class StrandWriter {
 public:
  /// Strands to write, with the modifications of each.
  struct Chosen {
    std::span<const uint32_t> strands;  ///< indices, ascending
    std::span<const float> width;       ///< factor on the width of each strand
    std::vector<float> color;           ///< factor on the colours of each strand; may be empty
  };

  StrandWriter(size_t strands, size_t motion_keys, std::optional<AttributeClass> colors, bool has_roots);
  StrandWriter(Chosen chosen, size_t motion_keys, std::optional<AttributeClass> colors, bool has_roots);

  /// Returns how many of the `count` strands from index `first` on must be grown: all up to the last one that
  /// is written, or 0 if none of them is written.
  size_t needed(size_t first, size_t count) const;

  /// expect() sets the number of points of the next strand to write. expect_all() sets the number of points
  /// of every strand. Call before write().
  void expect(int points);
  void expect_all(int points);
  /// Returns the number of colour rows that a batch of strands with `points` points must have.
  size_t color_rows(int points) const;

  /// Writes motion key `key` of a batch whose first strand has the index `first`. Scales the offsets of
  /// points from their roots by `length`, but not the widths. Writes colours together with key 0.
  void write(const StrandBatch& batch, size_t first, size_t key, float length);
  /// Writes the ids and roots of the strands of a batch. The first strand has the index `first` and is
  /// follicle `begin`.
  void write_roots(const StrandBatch& batch, size_t first, const FollicleTree& follicles, size_t begin);
  /// Returns the arrays, and leaves this object empty.
  StrandArrays take();

 private:
  template <class Use>
  void each(const StrandBatch& batch, size_t first, const Use& use) const;
  void write_colors(const StrandBatch& batch, size_t first);

  std::optional<Chosen> chosen_;
  size_t keys_;
  std::optional<AttributeClass> colors_;
  bool has_roots_;
  StrandArrays arrays_;
};

}  // namespace pelage
