// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/adaptive_params.h"

namespace pelage {

const Schema<AdaptiveParams>& AdaptiveParams::schema() {
  static const Schema<AdaptiveParams> table = [] {
    Schema<AdaptiveParams> s(
        "adaptive",
        "Adaptive sampling: takes more samples where the picture is noisy. A pilot pass over the frame "
        "decides the number of samples of each pixel, without bias. With `integrator: gather` or "
        "`filter_samples: splatted`, it decides the number of samples of each tile of 16 x 16 pixels, with a "
        "bias far below the noise. `samples` of render is then the maximum per pixel.");
    s.set_example(R"(render:
  samples: 1024   # the maximum per pixel
  adaptive: {noise: 0.02})");
    s.key(
        "noise", &AdaptiveParams::noise,
        {.help = "Noise budget: half of the 95 % confidence interval of a pixel's luminance, divided by "
                 "the luminance. Pixels darker than a tenth of the picture's mean are treated as if they had "
                 "a tenth of the mean",
         .min = 1e-4,
         .max = 10});
    s.key(
        "goal", &AdaptiveParams::goal,
        {.help = "Which noise must meet the budget. `frame`: the root mean square of the noise of all pixels "
                 "whose samples vary. Pelage meets this budget with as few samples in total as possible. "
                 "`pixel`: the noise of each pixel"});
    s.key("pilot", &AdaptiveParams::pilot,
          {.help = "Samples per pixel in the pilot pass. Pixels in areas where nothing is hit and nothing "
                   "varies get a quarter of them",
           .min = 4,
           .max = 65536});
    s.remove({"rule", "the rule `seed` made pictures too dark, and `two-stage` is always used", "two-stage"});
    s.remove({"batch", "it belonged to the rule `seed`, which made pictures too dark"});
    return s;
  }();
  return table;
}

}  // namespace pelage
