// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "procedurals/fine_boxes.h"
#include "render/accel/ray_slabs.h"

namespace pelage {

/// Where the ray enters the first of the fine boxes that it meets before `far`; infinity when it meets none.
/// Adds to `tests` how many boxes were looked at.
float enter_fine_boxes(const FineBoxes& boxes, const RaySlabs& ray, float far, int64_t& tests);

}  // namespace pelage
