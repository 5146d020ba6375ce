// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "view/picture.h"

namespace pelage {

/// Returns state.json: the status, and the version and size of the last picture. Keys are in docs/VIEW.md.
std::string state_json(const ViewStatus& status, const Picture* picture);

}  // namespace pelage
