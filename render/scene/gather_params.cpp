// SPDX-License-Identifier: Apache-2.0
#include "render/scene/gather_params.h"

namespace pelage {

const Schema<GatherParams>& GatherParams::schema() {
  static const Schema<GatherParams> table = [] {
    Schema<GatherParams> s("gather",
                           "Settings of `integrator: gather`, which shares shadow rays and indirect paths "
                           "among the samples that see the same piece of a strand or skin.");
    s.set_example(R"(render:
  integrator: gather
  gather: {spacing: 4, light_rays: 3})");
    s.key("visibility", &GatherParams::visibility,
          {.help =
               "How visible strands are found. `raster`: strands and skins are drawn tile by tile. For fewer "
               "than 0.2 % of the samples, this finds another strand than `rays`. Needs `accel: fur` and "
               "`curves: flat`. `rays`: by the camera rays of `integrator: path`",
           .default_text = "raster; rays without `accel: fur` or `curves: flat`"});
    s.key("reuse", &GatherParams::reuse,
          {.help = "false: samples share nothing. Then nothing is approximated, but the picture is as noisy "
                   "as with `integrator: path`. Set it to false to measure what sharing changes"});
    s.key(
        "spacing", &GatherParams::spacing,
        {.unit = "pixels",
         .help = "Maximum distance between gather points along a strand. Samples near a gather point share "
                 "the light that arrives there. A larger distance gives less noise, but blurs shadows along "
                 "strands. Indirect light is also averaged over neighbouring strands, over about 4 pixels",
         .min = 0.25,
         .max = 64});
    s.key("skin_spacing", &GatherParams::skin_spacing,
          {.unit = "pixels",
           .help = "Maximum distance between gather points on a skin",
           .min = 0.25,
           .max = 64});
    s.key("cells", &GatherParams::cells,
          {.help = "true: strands so thin that few samples see a gather point share light with their "
                   "neighbours on the skin, over about 2 pixels"});
    s.key("min_width", &GatherParams::min_width,
          {.unit = "pixels",
           .help =
               "The camera sees thinner strands at this width and more transparent, so that the picture is "
               "the same on average. This reduces the noise of strands thinner than a twentieth of a pixel, "
               "and increases the noise of dense fur. Strands that level of detail has widened keep their "
               "width. Needs `visibility: raster`",
           .min = 0,
           .max = 4});
    s.key("light_rays", &GatherParams::light_rays,
          {.help =
               "Mean number of shadow rays per camera sample that sees a strand or skin. Most of them go to "
               "lights that would add much to the brightness of the pixel if nothing blocked them, and whose "
               "visibility is uncertain. A sample sends at most one ray to each light, or two if there is "
               "only one light",
           .min = 0.05,
           .max = 16});
    s.key(
        "reject", &GatherParams::reject,
        {.help =
             "true: the rule of the slides \"Rendering Fur in Life of Pi\", for comparison only. Directions "
             "from which none of the first rays of a tile arrived get no further rays. Light that the "
             "first rays miss is lost, so the picture is too dark; `pelage measure samplers` shows by "
             "how much"});
    s.key("paths", &GatherParams::paths,
          {.help = "Indirect paths per camera sample that sees a strand or skin; dark surfaces get fewer",
           .min = 0.05,
           .max = 1});
    s.key("cache", &GatherParams::cache,
          {.help = "true: indirect paths end at the third surface. There, shadow rays are traced, and all "
                   "other light is read from a cache of cells about 8 pixels large, which paths of the "
                   "whole picture fill first. Glossy skins are not cached. Needs `reuse: true`",
           .default_text = "true with at least 3 `bounces`; with more than 8 skins, at least 8"});
    s.key("cache_paths", &GatherParams::cache_paths,
          {.help = "Paths that fill the cache, per camera sample", .min = 0.001, .max = 64});
    s.key(
        "memory", &GatherParams::memory,
        {.help =
             "Maximum memory of the cache. Pelage reserves about 360 bytes per pixel with one light and 560 "
             "with three (more in small pictures), but at most about 94 MB and 147 MB. With less memory, the "
             "cache is filled in several slices, which takes longer but changes no pixel. About a third "
             "of these figures suffices; Pelage refuses smaller limits",
         .default_text = "a quarter of what `render.memory` leaves, or more if that does not suffice"});
    return s;
  }();
  return table;
}

}  // namespace pelage
