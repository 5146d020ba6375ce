// SPDX-License-Identifier: Apache-2.0
#include "render/render_params.h"

namespace pelage {

const Schema<RenderParams>& RenderParams::schema() {
  static const Schema<RenderParams> table = [] {
    Schema<RenderParams> s("render", "How the picture is computed.");
    s.key("integrator", &RenderParams::integrator, {.help = "Method"});
    s.key("accel", &RenderParams::accel, {.help = "What rays are traced with"});
    s.key("curves", &RenderParams::curves,
          {.help = "Strands as ribbons that face each ray, or as round tubes (slower, for close-ups)"});
    s.key("samples", &RenderParams::samples, {.help = "Paths per pixel", .min = 1, .max = 1 << 20});
    s.key(
        "bounces", &RenderParams::bounces,
        {.help = "Most scatterings of a path after the first; 0 = direct light only", .min = 0, .max = 1024});
    s.key("seed", &RenderParams::seed, {.help = "Of all random numbers of the picture"});
    s.key("memory", &RenderParams::memory,
          {.help = "Limit for strands, trees, skins, caches and film; running into it is an error"});
    return s;
  }();
  return table;
}

}  // namespace pelage
