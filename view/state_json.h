// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "view/picture.h"
#include "view/view_status.h"

namespace pelage {

/// Returns state.json: the status, the version and size of the last picture, and the region to refine. Keys
/// are in docs/VIEW.md.
std::string state_json(const ViewStatus& status, const Picture* picture,
                       const std::optional<PixelBox>& region);

}  // namespace pelage
