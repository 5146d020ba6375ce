// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "groom/groom.h"

namespace pelage {

/// Returns the indices of up to `count` follicles that are spread over a groom: those with the smallest
/// priorities, which are random numbers of their ids. Does not depend on how the groom is divided into
/// leaves.
std::vector<size_t> spread_follicles(const Groom& groom, size_t count);

}  // namespace pelage
