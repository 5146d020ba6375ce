// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/color.h"

#include "base/value_readers.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"

namespace pelage {
namespace {

using ColorTest = OperatorTest;

TEST_F(ColorTest, FrequencyIsTheLeastThatHoldsTheColours) {
  const auto frequency = [](const char* field, float variation) {
    return Color({.value = scene_text::read<Field>(field), .variation = variation}).traits().colors;
  };
  EXPECT_EQ(frequency("[1, 0.5, 0]", 0), AttributeClass::kConstant);
  EXPECT_EQ(frequency("[1, 0.5, 0]", 0.2f), AttributeClass::kPerStrand);
  EXPECT_EQ(frequency("{ramp: {along: x, knots: [[0, 0], [1, 1]]}}", 0), AttributeClass::kPerStrand);
  EXPECT_EQ(frequency("{ramp: {along: strand, knots: [[0, 0], [1, 1]]}}", 0), AttributeClass::kPerPoint);
}

TEST_F(ColorTest, RampsRunAlongStrandsAndColoursMayBeBuiltOn) {
  const Color first = prepared<Color>(
      {.value = scene_text::read<Field>("{ramp: {along: strand, knots: [[0, [0, 1, 0]], [1, [1, 0, 0]]]}}")});
  const Color second =
      prepared<Color>({.value = scene_text::read<Field>("{product: [{attribute: color}, 0.5]}")});
  auto batch = straight();
  batch->colors.resize(8);
  first.apply(*batch);
  second.apply(*batch);
  for (int p = 0; p < 8; ++p) {
    const V3f color = vector_at(batch->colors[static_cast<size_t>(p)], 3);
    EXPECT_NEAR(color.x, 0.5f * batch->along(p), 1e-6f);
    EXPECT_NEAR(color.y, 0.5f * (1 - batch->along(p)), 1e-6f);
  }
}

}  // namespace
}  // namespace pelage
