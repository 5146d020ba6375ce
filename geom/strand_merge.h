// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// Merges batches into one, ordered by id (ties: in order of the batches). The batches must have the same
/// basis and number of motion keys. Keeps attributes that every batch has, at the highest frequency of any
/// batch; keeps roots and root uvs when every non-empty batch has them.
Strands merge(std::span<const Strands> batches);

}  // namespace pelage
