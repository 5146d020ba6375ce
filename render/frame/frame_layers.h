// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "render/film/film_layers.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Returns the layers of a frame's film. Needs only parameters, so it can be called before geometry and
/// lights of the frame are made.
FilmLayers frame_layers(const ImageParams& image, const RenderParams& render,
                        const std::vector<FilmLayers::LightInfo>& lights,
                        std::span<const MaterialParams> materials);

}  // namespace pelage
