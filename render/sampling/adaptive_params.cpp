// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/sampling/adaptive_rule_test.cpp.
#include "render/sampling/adaptive_params.h"

namespace pelage {

const Schema<AdaptiveParams>& AdaptiveParams::schema() {
  static const Schema<AdaptiveParams> table = [] {
    Schema<AdaptiveParams> s("adaptive",
                             "Samples where the noise is; `samples` of `render` is then the most that a "
                             "pixel gets.");
    s.key(
        "rule", &AdaptiveParams::rule,
        {.help = "`two-stage`: a pilot of the whole frame decides how many samples each pixel gets, without "
                 "bias. `seed`: each pixel goes on until it looks converged; as it is the same samples that "
                 "end it, rare bright ones are lost and the picture is too dark"});
    s.key("noise", &AdaptiveParams::noise,
          {.help = "Noise budget: half of the 95 % confidence interval of a pixel's luminance, over the "
                   "luminance. Two-stage: pixels darker than a tenth of the picture's mean count as if they "
                   "were as bright as that",
           .min = 1e-4,
           .max = 10});
    s.key("goal", &AdaptiveParams::goal,
          {.help = "Two-stage: whether the root mean square over the noisy pixels of the frame keeps the "
                   "budget, by the least number of samples, or each pixel"});
    s.key("pilot", &AdaptiveParams::pilot,
          {.help = "Two-stage: samples that a pixel gets before counts are decided; a quarter of them where "
                   "nothing is met and nothing varies",
           .min = 4,
           .max = 65536});
    s.key("batch", &AdaptiveParams::batch,
          {.help = "Seed: samples between looks at a pixel", .min = 2, .max = 65536});
    return s;
  }();
  return table;
}

}  // namespace pelage
