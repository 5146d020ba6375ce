// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/light/light.h"
#include "tests/render/random.h"

namespace pelage {

/// Irradiance of a surface at `from` with a normal, by light sampling. `missed`: samples without light.
inline double irradiance(const Light& light, const V3f& from, const V3f& normal, int samples,
                         int* missed = nullptr) {
  TestRandom random(31);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    const auto s = light.sample(from, random.unit2());
    if (missed) *missed += !s;
    if (s) sum += luminance(s->radiance) * std::max(0.0f, s->direction.dot(normal)) / s->pdf;
  }
  return sum / samples;
}

/// sample(), intersect(), pdf() and pdf_of_hit() agree, and pdf() is 0 where rays miss.
inline void expect_agreement(const Light& light, const V3f& from) {
  TestRandom random(5);
  int edge = 0;
  for (int i = 0; i < 3000; ++i) {
    const V3f any = random.direction();
    ASSERT_EQ(light.pdf(from, any) > 0, light.intersect(from, any).has_value());
    const auto s = light.sample(from, random.unit2());
    if (!s) continue;
    ASSERT_NEAR(s->direction.length(), 1, 1e-5f);
    const auto hit = light.intersect(from, s->direction);
    if (!hit) {
      ++edge;
      continue;
    }
    if (std::isinf(s->distance)) {
      ASSERT_TRUE(std::isinf(hit->distance));
    } else {
      ASSERT_NEAR(hit->distance, s->distance, 2e-3f * std::max(1.0f, s->distance));
    }
    ASSERT_NEAR(light.pdf(from, s->direction) / s->pdf, 1, 2e-3f);
    ASSERT_EQ(light.pdf_of_hit(from, s->direction, *hit), light.pdf(from, s->direction));
  }
  EXPECT_LE(edge, 8) << "directions that rounding carried over the edge";
}

}  // namespace pelage
