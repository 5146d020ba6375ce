// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "render/film/film_layers.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// The layers of a frame's film, which are known before anything of the frame is made.
FilmLayers frame_layers(const ImageParams& image, const RenderParams& render,
                        const std::vector<FilmLayers::LightInfo>& lights,
                        std::span<const MaterialParams> materials);

}  // namespace pelage
