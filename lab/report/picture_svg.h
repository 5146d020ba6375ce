// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// A picture with its labels as an inline SVG element, with the pixels as embedded PNG.
std::string picture_svg(const Picture& picture);

}  // namespace pelage
