// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "groom/strand_batch.h"

namespace pelage {

// The state of strands between two frozen operators, to the last bit, in rest space: what lets a coat be
// grown again from the middle of its operators. Widths that nothing has set and colours that are still white
// take no room.

/// Appends a batch.
void append_layer(const StrandBatch& batch, std::vector<std::byte>& bytes);
/// Reads the batch that stands at `at` into one that has been started, with the same strands, and moves `at`
/// behind it. False, with the batch in any state, when what stands there is something else.
bool read_layer(std::span<const std::byte> bytes, size_t& at, StrandBatch& batch);

}  // namespace pelage
