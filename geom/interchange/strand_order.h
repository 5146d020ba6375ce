// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "geom/strands.h"

namespace pelage {

/// Sorts strands by ids, one per strand, if all ids differ. Changes nothing if there is another number of
/// ids, or if two are equal. The strands must have one motion key; their own ids and roots stay as they are.
/// Needs memory for another copy of the points, of the largest attribute and of the index of the strands.
void sort_by_id(std::span<const uint64_t> ids, StrandArrays& arrays);

}  // namespace pelage
