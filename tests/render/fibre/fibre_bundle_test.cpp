// SPDX-License-Identifier: Apache-2.0
// Multiple scattering in a dense bundle of straight fibres, against brute force: cylinders in place of
// curves, and light that leaves each of them where refraction sends it.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "render/fibre/attenuation.h"
#include "render/fibre/chiang.h"
#include "tests/render/path/path_scene.h"

namespace pelage::fibre_bundle_test {
namespace {

constexpr int kFibres = 120, kBounces = 12, kRuns = 8, kPixels = 24, kSamples = 32;
constexpr float kRadius = 0.02f, kBundle = 0.42f, kHalfLength = 2, kDistance = 10, kFov = 3;
const Rgb kAbsorption(0.1f, 0.18f, 0.38f);

ChiangParams fibre() {
  ChiangParams params;
  params.absorption = kAbsorption;
  return params;
}

/// Axes in the plane across: nearly as dense as they can be at random without touching.
std::vector<V2f> axes() {
  std::vector<V2f> all;
  SampleStream stream(11, 0, 0, 0);
  while (all.size() < kFibres) {
    const V2f u = stream.next2d(), at = kBundle * (2.0f * u - V2f(1));
    bool free = at.length() < kBundle;
    for (const V2f& other : all) free = free && (at - other).length() > 2.1f * kRadius;
    if (free) all.push_back(at);
  }
  return all;
}

struct Estimate {
  std::array<double, 3> mean{}, standard_error{};
};

template <class Draw>
Estimate estimate(int count, Draw draw) {
  std::array<double, 3> sum{}, squares{};
  for (int i = 0; i < count; ++i) {
    const Rgb value = draw(static_cast<uint32_t>(i));
    for (int c = 0; c < 3; ++c) {
      sum[static_cast<size_t>(c)] += value[c];
      squares[static_cast<size_t>(c)] += static_cast<double>(value[c]) * value[c];
    }
  }
  Estimate result;
  for (size_t c = 0; c < 3; ++c) {
    result.mean[c] = sum[c] / count;
    const double variance = squares[c] / count - result.mean[c] * result.mean[c];
    result.standard_error[c] = std::sqrt(std::max(0.0, variance) / (count - 1));
  }
  return result;
}

/// Fibres that lie along a tangent, by brute force.
class Bundle {
 public:
  explicit Bundle(float slant)
      : tangent_(0, std::cos(slant), std::sin(slant)),
        across_(0, -std::sin(slant), std::cos(slant)),
        axes_(axes()),
        material_(fibre()) {}

  Strands strands() const {
    StrandArrays a;
    a.first_point = {0};
    for (size_t i = 0; i < axes_.size(); ++i) {
      for (int k = -4; k <= 4; ++k) {
        const V3f p = center(i) + 0.25f * static_cast<float>(k) * kHalfLength * tangent_;
        a.points.insert(a.points.end(), {p.x, p.y, p.z, kRadius});
      }
      a.first_point.push_back(static_cast<uint32_t>(9 * (i + 1)));
      a.ids.push_back(i);
    }
    return Strands(std::move(a));
  }

  /// What one ray from the eye finds of a white sky.
  Rgb trace(uint32_t path) const {
    SampleStream stream(3, path, 2, 0);
    const V2f at = stream.next2d();
    const float half_width = std::tan(0.5f * kFov * kPi / 180);
    V3f origin(0, 0, kDistance);
    V3f direction = V3f((2 * at.x - 1) * half_width, (2 * at.y - 1) * half_width, -1).normalized();
    Rgb weight(1);
    size_t own = axes_.size();
    for (int scattered = 0;; ++scattered) {
      float distance = 0;
      const size_t hit = nearest(origin, direction, own, distance);
      if (hit == axes_.size()) return weight;
      if (scattered > kBounces) return Rgb(0);
      const V3f entry = origin + distance * direction;
      const float along = entry.dot(tangent_);
      const FibreFrame frame(tangent_, -direction);
      const V3f normal = (entry - along * tangent_ - center(hit)) / kRadius;
      const float h = std::clamp(-frame.to_local(normal).z, -1.0f, 1.0f);
      const ChiangBsdf bsdf = material_.at(frame, h, Rgb(1));
      const auto sample = bsdf.sample(stream.next3d());
      if (!sample) return Rgb(0);
      weight *= sample->value.total() / sample->value.pdf;
      direction = sample->wi;
      origin = center(hit) + along * tangent_ +
               kRadius * exit_normal(frame, h, bsdf.densities(frame.angles(direction)), stream.next1d());
      own = hit;
    }
  }

 private:
  V3f center(size_t i) const { return axes_[i].x * V3f(1, 0, 0) + axes_[i].y * across_; }

  size_t nearest(const V3f& origin, const V3f& direction, size_t own, float& distance) const {
    size_t hit = axes_.size();
    distance = 1e30f;
    const V2f from(origin.x, origin.dot(across_)), d(direction.x, direction.dot(across_));
    for (size_t i = 0; i < axes_.size(); ++i) {
      if (i == own) continue;
      const V2f beside = from - axes_[i];
      const float a = d.dot(d), b = beside.dot(d), c = beside.dot(beside) - kRadius * kRadius;
      const float root2 = b * b - a * c;
      if (!(root2 > 0)) continue;
      const float t = (-b - std::sqrt(root2)) / a;
      if (!(t > 0 && t < distance) || std::abs((origin + t * direction).dot(tangent_)) > kHalfLength)
        continue;
      distance = t;
      hit = i;
    }
    return hit;
  }

  /// Where light leaves, on a random one of the ways on which it can come there. Each leg inside turns the
  /// place by pi - 2 gamma_t.
  static V3f exit_normal(const FibreFrame& frame, float h, const std::array<float, kFibreLobes>& densities,
                         float u) {
    const FibreCrossing crossing(1.55f, 0, frame.sin_theta_o(), frame.cos_theta_o(), h);
    const auto amplitudes = attenuations(crossing.reflectance, transmittance(kAbsorption, crossing.leg()));
    std::array<float, kFibreLobes> share;
    float total = 0;
    for (size_t p = 0; p < kFibreLobes; ++p) total += share[p] = amplitudes[p].y * densities[p];
    size_t p = 0;
    for (float rest = u * total; p + 1 < kFibreLobes && rest >= share[p]; ++p) rest -= share[p];
    return frame.direction(0, 1, -std::asin(h) - static_cast<float>(p) * (kPi - 2 * crossing.gamma_t));
  }

  V3f tangent_, across_;
  std::vector<V2f> axes_;
  ChiangMaterial material_;
};

/// Paths that went on from where they met a fibre would find the bundle some percent brighter.
TEST(FibreBundle, ScattersAsByBruteForce) {
  for (float slant : {0.0f, 0.6f}) {
    const Bundle bundle(slant);
    const Estimate truth = estimate(160000, [&](uint32_t path) { return bundle.trace(path); });
    for (CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
      PathScene scene(kPixels, kPixels);
      scene.add_fur(bundle.strands(), fibre());
      scene.add_sky(Rgb(1));
      scene.camera.fov = kFov;
      scene.render.curves = shape;
      scene.render.bounces = kBounces;
      scene.render.samples = kSamples;
      const Estimate rendered = estimate(kRuns, [&](uint32_t run) {
        scene.render.seed = 40 + run;
        return picture_mean(scene.run().film).mean;
      });
      // Eight runs know their own spread to a quarter only; by plain Monte Carlo it is that of as many paths
      // of the brute force.
      const double paths = double{kRuns} * kSamples * kPixels * kPixels;
      for (size_t c = 0; c < 3; ++c) {
        const double plain = truth.standard_error[c] * std::sqrt(160000 / paths);
        const double error_bound =
            std::hypot(truth.standard_error[c], std::max(plain, rendered.standard_error[c]));
        EXPECT_NEAR(rendered.mean[c], truth.mean[c], 3.5 * error_bound)
            << "channel " << c << ", slanted by " << slant
            << (shape == CurveShape::kFlat ? ", flat" : ", round");
        EXPECT_LT(error_bound, 0.012 * truth.mean[c]) << "enough paths";
      }
    }
  }
}

}  // namespace
}  // namespace pelage::fibre_bundle_test
