// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/strands.h"
#include "groom/follicles.h"
#include "groom/strand_batch.h"

namespace pelage {

/// Collects the strands of finished batches in the arrays of a Strands, whose memory is reserved exactly.
/// Writes all strands, or some strands with modified widths and colours.
class StrandWriter {
 public:
  /// The strands to write, as ascending indices. Each has a factor on its width and a factor on its colours.
  struct Chosen {
    std::span<const uint32_t> strands;
    std::span<const float> width;
    std::vector<float> color;  ///< may be empty
  };

  StrandWriter(size_t strands, size_t motion_keys, std::optional<AttributeClass> colors, bool has_roots);
  StrandWriter(Chosen chosen, size_t motion_keys, std::optional<AttributeClass> colors, bool has_roots);

  /// Number of the `count` strands from `first` on that must be made: all up to the last strand that is
  /// written, or 0 if none is written.
  size_t needed(size_t first, size_t count) const;

  /// Sets the point count of the next strand / of all strands; call before writing.
  void expect(int points);
  void expect_all(int points);
  /// Number of colour rows that batches of strands with `points` points must have.
  size_t color_rows(int points) const;

  /// Writes a batch whose strands start at number `first`. Scales them by `length` about their roots, except
  /// for widths. Colours are written with key 0.
  void write(const StrandBatch& batch, size_t first, size_t key, float length);
  /// Writes ids and roots of the same strands, which are follicles [begin, ...).
  void write_roots(const StrandBatch& batch, size_t first, const FollicleTree& follicles, size_t begin);
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
