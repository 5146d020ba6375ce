// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "groom/strand_batch.h"

namespace pelage {

// Lossless state of strands between two frozen operators, in rest space. With it, a coat can be grown again
// from the middle of its list of operators. Widths that are not set and colours that are still white take no
// space.

/// Appends a batch.
void append_layer(const StrandBatch& batch, std::vector<std::byte>& bytes);
/// Reads the stored batch at `at` into `batch`, which has been started with the same strands, and advances
/// `at` past the stored batch. Returns false, with the batch in an unspecified state, when the bytes there
/// are not this batch.
bool read_layer(std::span<const std::byte> bytes, size_t& at, StrandBatch& batch);

}  // namespace pelage
