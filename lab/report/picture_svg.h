// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// Returns a picture with its labels as an inline SVG element. The pixels are embedded as a PNG file.
std::string picture_svg(const Picture& picture);

}  // namespace pelage
