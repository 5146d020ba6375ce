// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// Merges batches into one, ordered by id. Strands with equal ids are in the order of their batches. Empty
/// batches are ignored. The other batches must have the same basis and number of motion keys.
///
/// Keeps an attribute if every batch has it with the same number of components. Its frequency becomes the
/// highest of all batches, or per strand if its constant values differ. Keeps roots if every batch has roots,
/// and root uvs if every batch has root uvs.
Strands merge(std::span<const Strands> batches);

}  // namespace pelage
