// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "image/exr.h"
#include "render/film/film_layers.h"

namespace pelage {

/// Replaces negative values of a picture, which are noise: samples that share light subtract a guess of it.
/// In a pixel with such values, the parts of the light become those above zero, scaled so that they still add
/// up to the radiance; radiance below zero becomes zero. Direct and indirect parts then add up to their layer
/// in the same way, so image.event_layers changes no other layer. `channels`: all colours of
/// Film::exr_pixels(), in its order.
void make_positive(const FilmLayers& layers, std::vector<ExrChannel>& channels);

}  // namespace pelage
