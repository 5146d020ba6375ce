// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/parallel.h"
#include "geom/strands.h"

namespace pelage {

/// Merges batches into one, ordered by id. Strands with equal ids are in the order of their batches. Empty
/// batches are ignored. The other batches must have the same basis and number of motion keys.
///
/// Keeps an attribute unless batches have it with different numbers of components. Strands that lack it get 1
/// for "color" and "opacity", 0 for all others. An attribute is constant, per strand or per point; the result
/// has the finest of these that any batch has. If it is constant in all batches, but with different values,
/// the result is per strand. Keeps roots if every batch has roots, and root uvs if every batch has root uvs.
Strands merge(std::span<const Strands> batches, const Workers& workers = Workers::alone());

}  // namespace pelage
