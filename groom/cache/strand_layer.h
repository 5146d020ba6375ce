// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "groom/strands/strand_batch.h"

namespace pelage {

// Lossless storage of the state of strands between two frozen operators, in rest space. A coat can be grown
// again from this state, without the operators before it. Widths take no space before an operator sets them,
// and colours none while all are white.

/// Appends the state of a batch to `bytes`.
void append_layer(const StrandBatch& batch, std::vector<std::byte>& bytes);
/// Reads the state of a batch from `bytes` at `at`, and advances `at` past it. `batch` must have been started
/// with the same strands. Returns false when the bytes at `at` do not hold this batch; `batch` is then in an
/// unspecified state.
bool read_layer(std::span<const std::byte> bytes, size_t& at, StrandBatch& batch);

}  // namespace pelage
