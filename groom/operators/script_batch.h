// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "groom/operators/script_module.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// Some strands of a batch as arrays ordered by strand, which a script reads and writes.
struct ScriptBatch {
  /// Copies the strands at these indices of a batch, which may repeat. The new values are those of the batch.
  ScriptBatch(const StrandBatch& batch, std::span<const size_t> strands);

  /// Returns pointers to the arrays. The caller sets `seed` and `writes_colors`.
  PelageScriptBatch view();
  /// Writes the new values of all strands to a batch, of which this holds all strands in order.
  void write(StrandBatch& batch) const;

  size_t strands, points, color_rows;
  float scale;
  std::vector<uint64_t> ids;
  std::vector<float> positions, widths, colors, roots, frames, rest_roots, rest_frames, uv, clump;
  std::vector<float> new_positions, new_widths, new_colors;
};

}  // namespace pelage
