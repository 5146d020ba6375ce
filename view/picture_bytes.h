// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "view/picture.h"

namespace pelage {

/// Returns layers of a picture for the page. First a line of JSON with `version`, `edit`, `width`, `height`,
/// `grid`, `full`, `samples`, and `channels`, each with `name` and `type` (half, float, uint); the line is
/// filled with spaces to a multiple of 8 bytes. Then the channels one after the other, row by row,
/// little-endian. The picture must have the layers.
std::string layer_bytes(const Picture& picture, const std::vector<std::string>& layers);

/// Returns an EXR file of a picture that is still being rendered: its layers, and the attribute
/// `pelage:partial`. Throws Error (kFailed).
std::string partial_exr(const Picture& picture);

/// Returns an EXR file of a finished frame, as write_frame() writes it. Throws Error (kFailed).
std::string finished_exr(const FinishedFrame& frame);

}  // namespace pelage
