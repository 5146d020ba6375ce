// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/tangle.h"

#include <cmath>

#include "render/fibre/core_walk.h"

namespace pelage {
namespace {

/// After this, the remainder of a walk is negligible: fibres that absorb a thousandth keep less than 1 %.
constexpr int kMaxScatterings = 1000;
/// A walk that has gained this factor is diverging.
constexpr float kRunaway = 30;

V3f random_tangent(const FibreLay& lay, WalkRandom& random) {
  if (lay.spread == 0) {
    const float z = 2 * random.unit() - 1, turn = 2 * kPi * random.unit();
    const float across = std::sqrt(std::max(0.0f, (1 - z) * (1 + z)));
    return {across * std::cos(turn), across * std::sin(turn), z};
  }
  const auto normal_pair = [&] {
    const float radius = lay.spread * std::sqrt(-2 * std::log(1 - random.unit()));
    const float turn = 2 * kPi * random.unit();
    return V2f(radius * std::cos(turn), radius * std::sin(turn));
  };
  const V2f a = normal_pair(), b = normal_pair();
  return V3f(std::cos(lay.rise) + a.x, a.y, std::sin(lay.rise) + b.x).normalized();
}

/// Light that one walk returns to the surface z = 0.
double walk(const TangleScatter& scatter, const FibreLay& lay, V3f direction, WalkRandom& random) {
  float weight = 1;
  double height = 0;
  for (int i = 0; i < kMaxScatterings; ++i) {
    // A fibre blocks light in proportion to its visible width. So tentative hits at the max rate are accepted
    // with this probability.
    V3f tangent;
    do {
      height += static_cast<double>(direction.z) * random.free_path(1);
      if (height > 0) return weight;
      tangent = random_tangent(lay, random);
    } while (random.unit() >= tangent.cross(direction).length());
    TangleHit hit{tangent, -direction, 2 * random.unit() - 1};
    const V3f u(random.unit(), random.unit(), random.unit());
    const std::optional<FibreSample> s = scatter(hit, u);
    if (!s) return 0;
    weight *= s->value.total().y / s->value.pdf;
    direction = s->wi;
    if (weight > kRunaway) return weight;
    constexpr float kLight = 0.1f, kSurvival = 0.2f;
    if (weight < kLight) {
      if (random.unit() >= kSurvival) return 0;
      weight /= kSurvival;
    }
  }
  return 0;
}

}  // namespace

double tangle_reflectance(const TangleScatter& scatter, int walks, const FibreLay& lay) {
  double sum = 0;
  for (int i = 0; i < walks; ++i) {
    WalkRandom random(hash64(random_use("tangle"), static_cast<uint64_t>(i)));
    // Uniform light: downward, cosine-weighted.
    const float z = -std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(walks));
    const float turn = 2 * kPi * random.unit(), across = std::sqrt((1 - z) * (1 + z));
    const double back = walk(scatter, lay, {across * std::cos(turn), across * std::sin(turn), z}, random);
    if (back > kRunaway) return 2;
    sum += back;
  }
  return sum / walks;
}

}  // namespace pelage
