// SPDX-License-Identifier: Apache-2.0
// The mean transmittance of render/accel/screen_door.h.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/soak.h"

namespace pelage {
namespace {

/// Straight strands across a square, in clumps of strands side by side.
struct Thicket {
  static constexpr float kWidth = 0.002f;
  size_t clumps = 3000, clump = 1;
  float spread = 0;  ///< largest distance of a strand from the middle of its clump, in widths
  bool varies = false;

  TestChunks chunks(float opacity) const {
    StrandArrays a;
    std::vector<float> opacities;
    a.first_point.push_back(0);
    for (size_t s = 0; s < clumps * clump; ++s) {
      const auto random = [&](uint64_t of, uint64_t i) {
        return signed_float(hash64(of, i, random_use("thicket")));
      };
      const size_t c = s / clump;
      const float angle = 3.14159265f * random(c, 0), beside = 1.5f * random(c, 1);
      const V3f along(std::cos(angle), std::sin(angle), 0), across(-along.y, along.x, 0);
      const V3f middle = (beside + spread * kWidth * random(s, 2)) * across + V3f(0, 0, random(s, 3));
      for (int i = 0; i < 6; ++i) {
        const V3f p = middle + (0.8f * static_cast<float>(i) - 2) * along;
        a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.5f * kWidth});
        opacities.push_back(varies ? 2 * opacity * static_cast<float>(i) / 5 : opacity);
      }
      a.first_point.push_back(a.first_point.back() + 6);
      a.ids.push_back(s);
    }
    TestChunks chunks;
    chunks.widest = kWidth;
    chunks.add_fur(Strands(std::move(a)), 0, std::move(opacities));
    return chunks;
  }
};

class ScreenDoorMean : public ChunkAccelTest {
 protected:
  struct Means {
    double product = 0, door = 0, deviation = 0;  // deviation: of the difference of the means
    double offset = 0, offset_deviation = 0;      // of hits of indirect rays
  };
  Means measure(const Thicket& thicket, float opacity, int rays) {
    const FlushDenormals flush;
    const TestChunks chunks = thicket.chunks(opacity);
    ResidentChunksOptions options;
    options.kind = AccelKind::kFur;
    options.fur.screen_door = true;
    const auto accel = make(chunks, chunks.bounds(1), options);
    TraceThread thread;
    double product = 0, door = 0, squares = 0, offsets = 0;
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
      const auto random = [&](uint64_t use) {
        return signed_float(hash64(i, use, random_use("thicket ray")));
      };
      Ray ray;
      ray.origin = {random(0), random(1), -3};
      ray.direction = V3f(0.3f * random(2), 0.3f * random(3), 1).normalized();
      const double all = accel->transmittance(ray, thread);
      ray.secondary = true;
      const double through = accel->transmittance(ray, thread);
      product += all;
      door += through;
      squares += (all - through) * (all - through);
      if (const Hit hit = accel->closest(ray, thread)) {
        offsets += hit.v;
        ++hits;
      }
    }
    return {product / rays, door / rays, std::sqrt(squares) / rays, offsets / hits, 0.6 / std::sqrt(hits)};
  }
  /// The first of several values; a soak test takes all of them.
  static std::vector<float> soaked(std::vector<float> values) {
    if (soak_scale() == 1) values.resize(1);
    return values;
  }
  /// Within 0.5 % of the true mean, which must be measured that accurately.
  void expect_unbiased(const Thicket& thicket, float opacity, const char* what) {
    const Means means = measure(thicket, opacity, 400000);
    SCOPED_TRACE(testing::Message() << what << ", opacity " << opacity << ": " << means.product << " "
                                    << means.door << " +- " << means.deviation);
    EXPECT_GT(means.product, 0.1);
    EXPECT_LT(means.product, 0.9);
    EXPECT_LT(2 * means.deviation, 0.005 * means.product);
    EXPECT_NEAR(means.door, means.product, 0.005 * means.product);
    EXPECT_NEAR(means.offset, 0, 4 * means.offset_deviation);
  }
};

TEST_F(ScreenDoorMean, OfIndependentStrandsIsKept) {
  for (const float opacity : soaked({0.4f, 0.3f, 0.5f})) expect_unbiased({}, opacity, "independent");
}

/// The mean of opacity times width along a strand whose opacity varies is kept point by point.
TEST_F(ScreenDoorMean, OfVaryingOpacityIsKept) { expect_unbiased({.varies = true}, 0.4f, "varying"); }

/// Windows in the middle of all strands would transmit 1 - opacity through a clump whose strands coincide,
/// instead of (1 - opacity)^6.
TEST_F(ScreenDoorMean, OfTightClumpsIsKept) {
  for (const float spread : soaked({0.0f, 0.1f, 0.5f})) {
    expect_unbiased({.clumps = 500, .clump = 6, .spread = spread}, 0.3f, "clumps");
  }
}

}  // namespace
}  // namespace pelage
