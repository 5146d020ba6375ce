// SPDX-License-Identifier: Apache-2.0
#include "render/film/film_layers.h"

namespace pelage {

const Schema<ImageParams>& ImageParams::schema() {
  static const Schema<ImageParams> table = [] {
    Schema<ImageParams> s("image", "Size and layers of the picture.");
    s.set_example(R"(image: {width: 1920, height: 1080, filter: blackman-harris})");
    s.key("width", &ImageParams::width, {.unit = "pixels", .help = "Width", .min = 1, .max = 65536});
    s.key("height", &ImageParams::height, {.unit = "pixels", .help = "Height", .min = 1, .max = 65536});
    s.key("filter", &ImageParams::filter,
          {.help = "Pixel filter: `box` is one pixel wide, `blackman-harris` three"});
    s.key("filter_samples", &ImageParams::filter_samples,
          {.help =
               "`drawn`: sample positions are distributed like the filter (filter importance sampling); each "
               "sample counts for one pixel only, so pixels are independent of each other. `splatted`: "
               "samples are distributed uniformly, and each sample is added to every pixel whose filter "
               "covers it. With `blackman-harris` this halves the variance at the same number of samples, "
               "but the noise of neighbouring pixels is correlated. No samples are taken outside the "
               "picture, so the filters of the outermost pixels are cut off at its border. With "
               "`adaptive`, all pixels of a tile of 16 x 16 get the same number of samples",
           .default_text = "drawn; splatted with `integrator: gather`"});
    s.key("light_layers", &ImageParams::light_layers,
          {.help = "One layer per light and lobe, named light.lobe.R; the layers add up to the picture"});
    s.key("event_layers", &ImageParams::event_layers,
          {.help =
               "Adds two layers for each light and lobe, light.lobe.direct and light.lobe.indirect, which "
               "add up to light.lobe. Direct light reaches the first visible surface straight from the "
               "light source; indirect light was scattered at least once on its way there. Light sources "
               "that the camera sees stay in the layer light.emission. Needs `light_layers`; the film takes "
               "up to twice the memory"});
    s.key(
        "noise_layers", &ImageParams::noise_layers,
        {.help =
             "Adds the layers `samples` (number of samples per pixel) and `noise` (standard error of the "
             "luminance). Adaptive sampling always adds them. With `filter_samples: splatted`, `noise` is "
             "computed from the pixel's own samples only and is too high: with `blackman-harris`, about "
             "1.5 times the true error. With `integrator: gather`, the samples of a pixel are taken in four "
             "parts that share no light, and `noise` comes from the differences of the parts; it does not "
             "contain the error of the reflection cache, which all parts share"});
    s.key("lod_layer", &ImageParams::lod_layer,
          {.help = "Adds the layer `lod`: in each pixel, the fraction of strands that render.lod removed "
                   "from the front-most coat; 0 where a skin is front-most. `tools/exr_to_png IN.exr OUT.png "
                   "lod` shows it in false colours"});
    s.key(
        "background", &ImageParams::background,
        {.help = "Picture behind everything, stretched over the whole picture, in place of the environments "
                 "that the camera would see. It illuminates nothing, is not exposed, and has the layer "
                 "`background`. Alpha stays 0 where only the background is seen",
         .default_text = "visible lights"});
    return s;
  }();
  return table;
}

FilmLayers FilmLayers::make(const std::vector<LightInfo>& lights, int groups, bool events) {
  FilmLayers layers;
  layers.groups = groups;
  layers.events = events;
  for (const LightInfo& light : lights) {
    layers.first_.push_back(layers.names.size());
    for (int g = 0; g < groups; ++g) layers.names.push_back(light.name + "." + kLobeGroupNames[g]);
    if (light.visible) layers.names.push_back(light.name + ".emission");
  }
  layers.first_direct_ = layers.names.size();
  for (size_t i = 0; events && i < lights.size(); ++i) {
    for (int g = 0; g < groups; ++g) layers.names.push_back(layers.names[layers.scattered(i, g)] + ".direct");
  }
  return layers;
}

}  // namespace pelage
