// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/compare/compared_frame.h"

namespace pelage {

/// A row per model and a column per light, in order of first occurrence, with their names. Missing frames are
/// grey. All pictures must have the same size; there must be at least one.
Picture contact_sheet(const std::vector<ComparedFrame>& frames);

}  // namespace pelage
