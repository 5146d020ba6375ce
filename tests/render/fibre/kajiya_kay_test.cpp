// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/kajiya_kay.h"

#include <gtest/gtest.h>

#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

TEST(KajiyaKay, NormOfTheHighlight) {
  KajiyaKayParams params;
  params.exponent = 10;
  const KajiyaKayMaterial ten(params);
  EXPECT_NEAR(ten.specular_norm(0, 1), 4.642122, 1e-4);
  EXPECT_NEAR(ten.specular_norm(std::sin(1.0f), std::cos(1.0f)), 2.522345, 1e-4);
  EXPECT_NEAR(ten.specular_norm(-std::sin(1.4f), std::cos(1.4f)), 1.046647, 1e-4);
  params.exponent = 200;
  const KajiyaKayMaterial sharp(params);
  EXPECT_NEAR(sharp.specular_norm(std::sin(1.0f), std::cos(1.0f)), .599471, 1e-4);
  EXPECT_NEAR(sharp.specular_norm(std::sin(1.4f), std::cos(1.4f)), .188777, 1e-4);
}

/// cos^p x <= exp(-p (1 - cos x)), so no sample weighs more than a bound.
TEST(KajiyaKay, WeightsAreBounded) {
  for (float exponent : {1.0f, 10.0f, 200.0f, 1000.0f}) {
    KajiyaKayParams params;
    params.exponent = exponent;
    params.specular = Rgb(0.9f);
    params.diffuse = 0.1f;
    const KajiyaKayMaterial material(params);
    TestRandom random(8);
    for (int i = 0; i < 20000; ++i) {
      const FibrePoint point = fibre_point_at(random.between(-1.57f, 1.57f), 0);
      const KajiyaKayBsdf bsdf(material, Rgb(1), FibreFrame(point.tangents[0], point.wo));
      const auto s = bsdf.sample(random.unit3());
      ASSERT_LT(s ? s->value.total().x / s->value.pdf : 0.0f, 5) << exponent;
    }
  }
}

TEST(KajiyaKay, DiffuseTermIsReciprocal) {
  KajiyaKayParams params;
  params.specular = Rgb(0);
  params.diffuse = 1;
  const KajiyaKayMaterial material(params);
  TestRandom random(6);
  for (int i = 0; i < 200; ++i) {
    const V3f t = random.direction(), a = random.direction(), b = random.direction();
    const KajiyaKayBsdf bsdf(material, Rgb(1), FibreFrame(t, a));
    EXPECT_NEAR(bsdf.eval(b).total().x / std::sqrt(1 - b.dot(t) * b.dot(t)), 1 / (kPi * kPi), 1e-5);
  }
}

}  // namespace
}  // namespace pelage
