// SPDX-License-Identifier: Apache-2.0
// Widths of distant coats (Simplification::distant()).
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "lod/simplification.h"

namespace pelage {
namespace {

TEST(DistantCoat, MaxWidthHoldsForAnyFit) {
  LodView pinhole;
  pinhole.open.focal_pixels = pinhole.close.focal_pixels = 1000;
  int raised = 0;
  for (uint64_t i = 0; i < 200; ++i) {
    const auto u = [&](uint64_t n) { return unit_float(hash64(i, n)); };
    const CoatStats stats{0.003f + 0.03f * u(1), 0.3f + u(2), std::pow(10.0f, -5 + 4.7f * u(3)), 50};
    WidthFit fit;
    for (size_t k = 1; k < fit.factors.size(); ++k)
      fit.factors[k] = std::clamp(fit.factors[k - 1] * (0.6f + 3 * u(3 + k)), 0.1f, 2.0f);
    SimplificationParams params;
    params.motion_blur = params.depth_of_field = i % 2 == 0;
    const Simplification coat =
        Simplification(params, pinhole, stats, 1).distant(i % 3 ? 0.25f : 0.03125f, fit);
    for (float distance = 2; distance < 2000; distance *= 1.5f) {
      const float max = coat.max_width_factor(distance);
      const float smallest = coat.share({V3f(0, 0, -distance), V3f(0, 0, -distance)});
      raised += coat.gain(smallest) < max * 0.999f;
      for (float share = smallest; share < 1; share *= 1.03f)
        ASSERT_LE(coat.width_factor(share, 0), max) << i << " " << distance << " " << share;
    }
  }
  EXPECT_GT(raised, 100) << "no fit whose widest strands are not at the smallest share";
}

}  // namespace
}  // namespace pelage
