// SPDX-License-Identifier: Apache-2.0
// A fibre so near to a light that it matters where across and along the fibre light leaves.
#include <cmath>

#include <gtest/gtest.h>

#include "render/fibre/attenuation.h"
#include "render/fibre/chiang.h"
#include "tests/render/path/path_scene.h"

namespace pelage::near_light_test {
namespace {

constexpr float kRadius = 0.4f;
constexpr float kFov = 4.4f;  // degrees; about as wide as the fibre
constexpr float kDistance = 10;

struct Estimate {
  double mean = 0, standard_error = 0;
};

template <class Draw>
Estimate estimate(int count, Draw draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double value = draw(static_cast<uint32_t>(i));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1))};
}

/// Independent estimates differ by chance alone; 4 standard errors are exceeded once in 16,000 times.
void expect_same(const Estimate& a, const Estimate& b, const std::string& where) {
  EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.standard_error, b.standard_error)) << where;
  EXPECT_LT(std::hypot(a.standard_error, b.standard_error), 0.015 * a.mean) << where << ": enough samples";
}

struct NearLight {
  std::string name;
  V3f position;
  float half_size;
};
const NearLight kLights[] = {{"beside", V3f(1.6f, 0.5f, 1.2f), 1}, {"behind", V3f(-1.2f, 0.5f, -1.2f), 0.7f}};

ChiangParams fibre() {
  ChiangParams params;
  params.absorption = Rgb(0.2f);
  params.beta_n = 0.1f;
  return params;
}

V3f axis_of(float slant) { return {0, std::cos(slant), std::sin(slant)}; }

Estimate rendered(const NearLight& light, float slant, CurveShape shape, int64_t seed,
                  DirectTechniques direct) {
  PathScene scene(16, 16);
  const V3f axis = axis_of(slant);
  scene.add_fur(one_strand({-8.0f * axis, -3.0f * axis, 3.0f * axis, 8.0f * axis}, kRadius), fibre());
  RectangleLightParams lamp;
  lamp.position = light.position;
  lamp.look_at = V3f(0);
  lamp.size = V2f(2 * light.half_size);
  scene.add_light("lamp", lamp);
  scene.camera.fov = kFov;
  scene.render.curves = shape;
  scene.render.bounces = 0;
  scene.render.samples = direct == DirectTechniques::kBoth ? 16 : 160;
  PathOptions options;
  options.direct = direct;
  return estimate(16, [&](uint32_t run) {
    scene.render.seed = seed + run;
    return luminance(picture_mean(scene.run(options).film).mean);
  });
}

/// By brute force: rays from the eye to a cylinder about the y axis; light sampled from the lobes; a straight
/// line from the place where that light leaves the cylinder, by refraction, to the rectangle or past it.
Estimate traced(const NearLight& light) {
  const ChiangParams params = fibre();
  const ChiangMaterial material(params);
  const V3f normal = -light.position.normalized();
  const V3f x = V3f(0, 1, 0).cross(normal).normalized(), y = normal.cross(x);
  const float half_width = std::tan(0.5f * kFov * kPi / 180);
  return estimate(600000, [&](uint32_t i) {
    SampleStream stream(3, i, 1, 0);
    const V2f at = stream.next2d();
    const V3f d = V3f((2 * at.x - 1) * half_width, (2 * at.y - 1) * half_width, -1).normalized();
    const float a = d.x * d.x + d.z * d.z, b = kDistance * d.z;
    const float root2 = b * b - a * (kDistance * kDistance - kRadius * kRadius);
    if (root2 < 0) return 0.0;
    const V3f entry = V3f(0, 0, kDistance) + (-b - std::sqrt(root2)) / a * d;
    const FibreFrame frame(V3f(0, 1, 0), -d);
    const float h = -frame.to_local(V3f(entry.x, 0, entry.z) / kRadius).z;
    const ChiangBsdf bsdf = material.at(frame, h, Rgb(1));
    const auto sample = bsdf.sample(stream.next3d());
    if (!sample) return 0.0;
    const V3f wi = sample->wi;
    // Each leg inside turns the place by pi - 2 gamma_t. Lobes are so narrow that what is rough turns light
    // there; only the longest ways leave all around. The sum over lobes says how likely each of them was.
    const FibreCrossing crossing(params.eta, 0, frame.sin_theta_o(), frame.cos_theta_o(), h);
    const auto amplitudes = attenuations(crossing.reflectance, transmittance(Rgb(0.2f), crossing.leg()));
    const auto densities = bsdf.densities(frame.angles(wi));
    double sum = 0;
    for (int p = 0; p < kFibreLobes; ++p) {
      const float azimuth = std::atan2(frame.to_local(wi).z, frame.to_local(wi).y);
      const float turned = p < 3 ? -std::asin(h) - static_cast<float>(p) * (kPi - 2 * crossing.gamma_t)
                                 : azimuth + std::asin(h);
      const V3f place = kRadius * frame.direction(0, 1, turned);
      const float along =
          entry.y - static_cast<float>(p) * kRadius * crossing.leg() * frame.sin_theta_o() / params.eta;
      const V3f from_lamp = place + V3f(0, along, 0) - light.position;
      const float descent = -wi.dot(normal);
      if (!(descent > 0)) continue;
      const V3f on_lamp = from_lamp + from_lamp.dot(normal) / descent * wi;
      if (std::abs(on_lamp.dot(x)) > light.half_size || std::abs(on_lamp.dot(y)) > light.half_size) continue;
      const auto lobe = static_cast<size_t>(p);
      sum += static_cast<double>(amplitudes[lobe].y * densities[lobe]) / sample->value.pdf;
    }
    return sum;
  });
}

/// Seen from the axis, the light beside the fibre would be a fifth darker, the one behind it a quarter
/// brighter.
TEST(NearLight, IsSeenFromWhereLightLeavesTheFibre) {
  for (const NearLight& light : kLights) {
    const Estimate truth = traced(light);
    for (CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
      const std::string where = light.name + (shape == CurveShape::kFlat ? ", flat" : ", round");
      expect_same(rendered(light, 0, shape, 100, DirectTechniques::kBoth), truth, where);
    }
  }
}

/// A ribbon is met deeper than a tube: on a slanted fibre, that is elsewhere along it. Without regard to
/// that, the two differ by a fifth.
TEST(NearLight, ShinesAlikeOnFlatAndRoundFibres) {
  const NearLight& light = kLights[1];
  for (float slant : {-0.5f, 0.5f}) {
    expect_same(rendered(light, slant, CurveShape::kFlat, 200, DirectTechniques::kBoth),
                rendered(light, slant, CurveShape::kRound, 300, DirectTechniques::kBoth),
                light.name + ", slanted by " + std::to_string(slant));
  }
}

/// Densities of points on the light are those of the lines that end there.
TEST(NearLight, IsTheSameBySamplesOfItAndOfLobes) {
  for (const NearLight& light : kLights) {
    const float slant = 0.1f;
    const Estimate both = rendered(light, slant, CurveShape::kFlat, 400, DirectTechniques::kBoth);
    expect_same(rendered(light, slant, CurveShape::kFlat, 500, DirectTechniques::kLightsOnly), both,
                light.name + ", lights");
    expect_same(rendered(light, slant, CurveShape::kFlat, 600, DirectTechniques::kLobesOnly), both,
                light.name + ", lobes");
  }
}

}  // namespace
}  // namespace pelage::near_light_test
