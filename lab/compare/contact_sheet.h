// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/compare/compared_frame.h"

namespace pelage {

/// Returns a picture with one row per model and one column per light, labelled with their names. Models and
/// lights are in order of their first occurrence. Places without a frame are grey. All frames must have
/// pictures of the same size, and there must be at least one frame.
Picture contact_sheet(const std::vector<ComparedFrame>& frames);

}  // namespace pelage
