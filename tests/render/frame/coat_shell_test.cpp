// SPDX-License-Identifier: Apache-2.0
#include "render/frame/coat_shell.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

TEST(CoatShell, WaysEndAtTheOuterSphereAndAtTheLight) {
  const CoatShell shell{0.5f, 1};
  const SkinBall ball{V3f(0), 1};
  EXPECT_FLOAT_EQ(shell.way(ball, V3f(0, 0, 1.2f), V3f(0, 0, 1), kFar), 0.3f);
  EXPECT_FLOAT_EQ(shell.way(ball, V3f(0, 0, 1.2f), V3f(0, 0, 1), 0.1f), 0.1f);
  EXPECT_FLOAT_EQ(shell.way(ball, V3f(0, 0, 3), V3f(0, 0, 1), kFar), 0);
  EXPECT_FLOAT_EQ(shell.way(ball, V3f(0, 1.2f, 3), V3f(0, 0, -1), kFar), 1.8f);  // enters and leaves
  EXPECT_FLOAT_EQ(shell.way(ball, V3f(0, 2, 0), V3f(0, 0, 1), kFar), 0);
  EXPECT_NEAR(shell.transmittance(ball, V3f(0, 0, 1.2f), V3f(0, 0, 1), kFar), std::exp(-0.3f), 1e-6f);
}

TEST(CoatShell, FindsTheDensityOfAUniformShell) {
  const CoatShell truth{0.4f, 7};
  std::vector<ShellRay> rays;
  for (uint32_t i = 0; i < 4000; ++i) {
    SampleStream stream(1, i, 0, 0);
    ShellRay ray;
    ray.ball = {V3f(1, 2, 3), 1};
    // Most places are just below the surface of the shell, so that the 95th percentile is near it.
    ray.origin =
        ray.ball.center + (1 + 0.4f * std::cbrt(stream.next1d())) * uniform_direction(stream.next2d());
    ray.direction = uniform_direction(stream.next2d());
    ray.far = i % 2 == 0 ? kFar : 0.3f;
    const float through = truth.transmittance(ray.ball, ray.origin, ray.direction, ray.far);
    ray.through = stream.next1d() < through ? 1.0f : 0.0f;
    rays.push_back(ray);
  }
  const CoatShell found = fit_shell(rays);
  EXPECT_NEAR(found.thickness, 0.4f, 0.01f);
  EXPECT_NEAR(found.density, 7, 0.7f);  // 4,000 rays of 0 or 1: about 3 standard errors
}

TEST(CoatShell, NoRaysMakeNoShell) { EXPECT_EQ(fit_shell({}).thickness, 0); }

}  // namespace
}  // namespace pelage
