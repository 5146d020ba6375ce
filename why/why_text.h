// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "why/pixel_why.h"

namespace pelage {

/// Returns an explanation as plain text of several lines, for people.
std::string why_text(const PixelWhy& why);

}  // namespace pelage
