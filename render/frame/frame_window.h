// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "image/exr.h"
#include "render/film/pixel_filter.h"

namespace pelage {

/// The part of a picture that one render computes. All boxes are in the pixel space of the whole picture.
///
/// A pixel of a region has the same samples as in the whole picture. With splatted samples, a pixel also
/// receives samples of the pixels around it, so these pixels are traced too.
struct FrameWindow {
  PixelBox picture;  ///< the whole picture
  PixelBox region;   ///< the pixels to compute
  PixelBox traced;   ///< the pixels that get samples: the region and an apron of the filter's radius
  PixelBox film;     ///< the pixels that the film stores: whole tiles of the picture that contain `traced`
};

/// Returns the window of a render. `region`: empty for the whole picture; it must lie within the picture.
/// `splat`: the filter of splatted samples, see FilmLayers.
FrameWindow frame_window(int width, int height, const std::optional<PixelBox>& region,
                         std::optional<PixelFilter> splat);

}  // namespace pelage
