// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "render/film/film.h"
#include "render/light/light_set.h"

namespace pelage {

/// A part of the light of a pixel.
struct LightTerm {
  std::string light;  ///< name of the light source
  std::string lobe;   ///< "diffuse" ..., of the first visible surface; "emission" for a light that is seen
  std::string event;  ///< "direct" or "indirect"; empty for emission
  Rgb radiance{0};
};

/// Returns the light of pixel (x, y) of a film by light source, lobe and event, the brightest first. The
/// terms add up to the pixel. The film must have event layers.
std::vector<LightTerm> light_terms(const Film& film, const LightSet& lights, int x, int y);

}  // namespace pelage
