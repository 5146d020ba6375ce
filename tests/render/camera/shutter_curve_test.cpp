// SPDX-License-Identifier: Apache-2.0
#include "render/camera/shutter_curve.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage::shutter_curve_test {

// Values are floats: rounded by at most 6e-8 times a few operations.
constexpr float kRounding = 1e-6f;

TEST(ShutterCurve, ABoxKeepsTheRandomNumber) {
  EXPECT_EQ(ShutterCurve().time(0.3f), 0.3f);
  EXPECT_NEAR(ShutterCurve({{0.2f, 5}, {0.4f, 5}}).time(0.3f), 0.3f, kRounding) << "constant beyond its ends";
}

TEST(ShutterCurve, TimesAreTheInverseOfTheIntegral) {
  const ShutterCurve triangle({{0, 0}, {0.5f, 7}, {1, 0}});
  const ShutterCurve trapezoid({{0, 0}, {0.25f, 1}, {0.75f, 1}, {1, 0}});
  for (float u = 0; u < 1; u += 1.0f / 64) {
    const float t = triangle.time(u);
    EXPECT_NEAR(t < 0.5f ? 2 * t * t : 1 - 2 * (1 - t) * (1 - t), u, kRounding) << u;
    const float s = trapezoid.time(u), plateau = 4.0f / 3;  // the weight whose mean is 1
    const float passed = s < 0.25f    ? 2 * plateau * s * s
                         : s <= 0.75f ? plateau * (s - 0.125f)
                                      : 1 - 2 * plateau * (1 - s) * (1 - s);
    EXPECT_NEAR(passed, u, kRounding) << u;
  }
}

TEST(ShutterCurve, NoTimeIsWhereTheShutterIsClosed) {
  const ShutterCurve twice({{0, 1}, {0.25f, 1}, {0.25f, 0}, {0.75f, 0}, {0.75f, 1}, {1, 1}});
  for (float u = 0; u < 1; u += 1.0f / 64) {
    const float t = twice.time(u);
    EXPECT_NEAR(t, u < 0.5f ? u / 2 : u / 2 + 0.5f, kRounding) << u;
  }
}

TEST(ShutterCurve, MistakesAreNamed) {
  const SourcePosition at{"scene.yaml", 3, 5};
  const auto message = [&](const Value& value) {
    Problems problems;
    ShutterCurve curve;
    EXPECT_FALSE(ValueReader<ShutterCurve>::read(value, {}, curve, problems));
    return problems.empty() ? std::string() : problems.list().front().message;
  };
  const auto points = [&](std::initializer_list<std::pair<const char*, const char*>> list) {
    std::vector<Value> items;
    for (const auto& [t, w] : list)
      items.push_back(Value::list(at, {Value::scalar(at, t), Value::scalar(at, w)}));
    return Value::list(at, std::move(items));
  };
  EXPECT_NE(message(Value::scalar(at, "trapezoyd")).find("did you mean 'trapezoid'?"), std::string::npos);
  EXPECT_NE(message(points({{"0.5", "1"}, {"0.2", "1"}})).find("decrease"), std::string::npos);
  EXPECT_NE(message(points({{"0", "1"}, {"2", "1"}})).find("between 0 and 1"), std::string::npos);
  EXPECT_NE(message(points({{"0", "1"}, {"1", "-1"}})).find("at least 0"), std::string::npos);
  EXPECT_NE(message(points({{"0", "0"}, {"1", "0"}})).find("no light"), std::string::npos);
}

}  // namespace pelage::shutter_curve_test
