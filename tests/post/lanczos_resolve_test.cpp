// SPDX-License-Identifier: Apache-2.0
#include "post/lanczos_resolve.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/post/picture.h"

namespace pelage {
namespace {

double lanczos(double t) {
  const double a = std::numbers::pi * t;
  if (std::abs(t) >= 3) return 0;
  return std::abs(t) < 1e-9 ? 1 : std::sin(a) / a * std::sin(a / 3) / (a / 3);
}

/// Every sample of every pixel within reach, one by one.
double slow(const Picture& p, int x, int y, int scale, double shift) {
  double sum = 0, weight = 0, low = 1e30, high = -1e30;
  for (int sy = (y - 3) * scale; sy < (y + 4) * scale; ++sy) {
    for (int sx = (x - 3) * scale; sx < (x + 4) * scale; ++sx) {
      if (sx < 0 || sy < 0 || sx >= p.width * scale || sy >= p.height * scale) continue;
      const double px = (sx + 0.5) / scale, py = (sy + 0.5) / scale;
      const int from = static_cast<int>(std::floor(px - shift));
      const double v =
          from < 0 || from >= p.width ? 0.0 : static_cast<double>(p.color[p.at(from, static_cast<int>(py))]);
      const double w = lanczos(px - x - 0.5) * lanczos(py - y - 0.5);
      sum += w * v;
      weight += w;
      if (px > x - 1 && px < x + 2 && py > y - 1 && py < y + 2) {
        low = std::min(low, v);
        high = std::max(high, v);
      }
    }
  }
  return std::clamp(sum / weight, low, high);
}

TEST(Lanczos, IsTheSumOverAllSamples) {
  for (int scale : {1, 3, 4, 6}) {
    for (float shift : {0.0f, 2.5f, -1.3f}) {
      Picture p(24, 20);
      p.each([&](int, int, size_t i) { p.motion[i] = {shift, 0}; });
      StereoSetup setup;
      setup.scale = scale;
      setup.strip_rows = 7;
      const Result result = other_eye(p, setup);
      for (int y = 0; y < p.height; y += 3) {
        for (int x = 0; x < p.width; ++x) {
          // Samples whose source lies on the border between two pixels may belong to either.
          ASSERT_NEAR(result.color[p.at(x, y)], slow(p, x, y, scale, shift), 2e-5)
              << x << " " << y << " " << scale << " " << shift;
        }
      }
    }
  }
}

TEST(Lanczos, LeavesConstantsAlone) {
  Picture p(40, 20);
  p.each([&](int, int y, size_t i) {
    p.color[i] = 0.3f;
    p.motion[i] = {0.11f * static_cast<float>(y), 0};
  });
  StereoSetup setup;
  setup.longest_fill = 40;
  for (const float v : other_eye(p, setup).color) ASSERT_EQ(v, 0.3f);
}

TEST(Lanczos, WhereNothingIsSeenThereIsNothing) {
  Picture p(40, 20);
  p.each([&](int, int, size_t i) { p.motion[i] = {1e6f, 0}; });
  for (const float v : other_eye(p, {}).color) ASSERT_EQ(v, 0);
}

TEST(Lanczos, RingingStaysWithinTheNeighbourhood) {
  Picture p(60, 24);
  p.each([&](int x, int, size_t i) { p.color[i] = x % 20 < 10 ? 0.0f : 1000.0f; });
  for (const float v : other_eye(p, {}).color) {
    ASSERT_GE(v, 0);
    ASSERT_LE(v, 1000);
  }
}

TEST(Lanczos, KeepsAnEdgeSharperThanTheBox) {
  // Half a pixel of shift: the box makes one pixel of grey; the sinc passes more of the finest detail.
  Picture p(64, 16);
  p.each([&](int x, int, size_t i) {
    p.color[i] = 0.5f + 0.5f * std::sin(static_cast<float>(x) * 1.9f);
    p.motion[i] = {0.5f, 0};
  });
  const auto contrast = [&](StereoFilter filter) {
    StereoSetup setup;
    setup.filter = filter;
    const Result result = other_eye(p, setup);
    double sum = 0;
    for (int x = 8; x < 56; ++x) sum += std::pow(result.color[p.at(x, 8)] - 0.5, 2);
    return std::sqrt(sum);
  };
  EXPECT_GT(contrast(StereoFilter::kLanczos), 1.1 * contrast(StereoFilter::kBox));
}

}  // namespace
}  // namespace pelage
