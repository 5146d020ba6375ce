// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "why/pixel_why.h"

namespace pelage {

/// Returns an explanation as an object of JSON. docs/VIEW.md describes its keys.
std::string why_json(const PixelWhy& why);

}  // namespace pelage
