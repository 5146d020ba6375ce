// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/film/film_test.cpp.
#include "render/film/film_layers.h"

namespace pelage {

const Schema<ImageParams>& ImageParams::schema() {
  static const Schema<ImageParams> table = [] {
    Schema<ImageParams> s("image", "Size and contents of the picture.");
    s.key("width", &ImageParams::width, {.unit = "pixels", .help = "Width", .min = 1, .max = 65536});
    s.key("height", &ImageParams::height, {.unit = "pixels", .help = "Height", .min = 1, .max = 65536});
    s.key("filter", &ImageParams::filter,
          {.help = "How a pixel weighs what falls around it: box is one pixel wide, blackman-harris three"});
    s.key("light_layers", &ImageParams::light_layers,
          {.help = "One layer per light and lobe, light.lobe.R; their sum is the picture"});
    s.key(
        "noise_layers", &ImageParams::noise_layers,
        {.help = "Layers `samples`, how many a pixel got, and `noise`, the standard error of its luminance; "
                 "adaptive sampling has them always"});
    s.key("lod_layer", &ImageParams::lod_layer,
          {.help = "Layer `lod`: the part of the strands that `render.lod` left out where the front-most one "
                   "stands, 0 on skins; `tools/exr_to_png IN.exr OUT.png lod` shows it in false colours"});
    return s;
  }();
  return table;
}

FilmLayers FilmLayers::make(const std::vector<LightInfo>& lights, int groups) {
  FilmLayers layers;
  layers.groups = groups;
  for (const LightInfo& light : lights) {
    layers.first_.push_back(layers.names.size());
    for (int g = 0; g < groups; ++g) layers.names.push_back(light.name + "." + kLobeGroupNames[g]);
    if (light.visible) layers.names.push_back(light.name + ".emission");
  }
  return layers;
}

}  // namespace pelage
