// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/display_image.h"
#include "why/pixel_why.h"

namespace pelage {

/// Renders the part of the picture around an explained pixel, enlarged, with the strand drawn over it: its
/// centre line, a dot at its root, and a frame around the pixel. Takes fewer samples than the picture if that
/// takes too long. Throws the errors of explain_pixel().
DisplayImage why_picture(const ExplainedFrame& frame, const PixelWhy& why, const Job& job);

}  // namespace pelage
