// SPDX-License-Identifier: Apache-2.0
#include "render/light/scatter_point.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/fibre/attenuation.h"
#include "render/fibre/fibre_material.h"
#include "render/sampling/sample_stream.h"

namespace pelage {
namespace {

constexpr float kRadius = 0.02f;

struct PointSetup {
  V3f tangent, wo;
  float h;
  FibreFrame frame() const { return FibreFrame(tangent, wo); }
  /// Of the circle where the fibre is met.
  V3f normal() const { return frame().to_world({0, std::sqrt(1 - h * h), -h}); }
};

PointSetup view(uint32_t i) {
  SampleStream stream(5, i, 0, 0);
  PointSetup v{uniform_direction(stream.next2d()), uniform_direction(stream.next2d()), 0};
  v.h = 1.98f * stream.next1d() - 0.99f;
  return v;
}

ScatterPoint point(const PointSetup& v, const V3f& axis) {
  FibrePoint at;
  at.tangents.fill(v.tangent);
  at.wo = v.wo;
  at.h = v.h;
  static const FibreMaterial material{ChiangParams{}};
  return {axis, v.tangent, kRadius, axis + kRadius * v.normal(), v.h, material.at(at)};
}

/// Part of `v` across the tangent, of unit length.
V3f across(const V3f& v, const V3f& tangent) { return (v - v.dot(tangent) * tangent).normalized(); }

TEST(ScatterPoint, ReflectedLightLeavesWhereItMetTheFibre) {
  for (uint32_t i = 0; i < 200; ++i) {
    const PointSetup v = view(i);
    const V3f n = v.normal(), wi = (2 * v.wo.dot(n)) * n - v.wo;
    EXPECT_LT((point(v, V3f(0)).start(wi) - kRadius * n).length(), 0.004f * kRadius) << i;
  }
}

/// The ways of refracted light through a circle, by angles at its centre.
TEST(ScatterPoint, LightThatWentInLeavesWhereRefractionSendsIt) {
  for (uint32_t i = 0; i < 200; ++i) {
    const PointSetup v = view(i);
    const FibreFrame frame = v.frame();
    const FibreCrossing crossing(1.55f, 0, frame.sin_theta_o(), frame.cos_theta_o(), v.h);
    const float gamma_t = std::asin(crossing.sin_gamma_t);
    for (int p = 1; p < 3; ++p) {
      // Each leg inside turns the place on the circle by the same angle.
      const float place = -std::asin(v.h) - static_cast<float>(p) * (kPi - 2 * gamma_t);
      const V3f expected = kRadius * frame.direction(0, 1, place);
      const V3f wi = frame.direction(-frame.sin_theta_o(), frame.cos_theta_o(), crossing.exit_azimuth(p));
      EXPECT_LT((point(v, V3f(0)).start(wi) - expected).length(), 0.004f * kRadius) << i << ' ' << p;
    }
  }
}

TEST(ScatterPoint, RaysBeginOutsideAndGoOut) {
  for (const V3f& axis : {V3f(0), V3f(40, -7, 90)}) {
    for (uint32_t i = 0; i < 500; ++i) {
      const PointSetup v = view(i);
      SampleStream stream(6, i, 0, 0);
      const V3f wi = uniform_direction(stream.next2d());
      const V3f from_axis = point(v, axis).start(wi) - axis;
      const V3f radial = from_axis - from_axis.dot(v.tangent) * v.tangent;
      EXPECT_GT(radial.length(), kRadius);
      EXPECT_LT(radial.length(), 1.01f * kRadius);
      EXPECT_GT(radial.dot(across(wi, v.tangent)), 0);
    }
  }
}

}  // namespace
}  // namespace pelage
