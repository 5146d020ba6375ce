// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/compare/compared_frame.h"

namespace pelage {

/// A row per model and a column per light, in the order in which each first occurs, with their names. Frames
/// that are missing leave a grey field. All pictures have one size. Not empty.
Picture contact_sheet(const std::vector<ComparedFrame>& frames);

}  // namespace pelage
