// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "groom/groom.h"

namespace pelage {

/// Expects that `part` is what `kept` says of the leaf `whole`, bit by bit.
inline void expect_strands_of(const Strands& whole, const KeptStrands& kept, const Strands& part) {
  ASSERT_EQ(part.strand_count(), kept.strands.size());
  ASSERT_EQ(part.motion_keys(), whole.motion_keys());
  ASSERT_EQ(part.attributes().size(), whole.attributes().size());
  for (size_t i = 0; i < kept.strands.size(); ++i) {
    const size_t s = kept.strands[i];
    ASSERT_EQ(part.id(i), whole.id(s));
    ASSERT_EQ(part.strand_points(i), whole.strand_points(s));
    ASSERT_EQ(part.has_roots(), whole.has_roots());
    if (whole.has_roots()) {
      EXPECT_EQ(part.root(i).u, whole.root(s).u);
    }
    EXPECT_EQ(part.root_uv(i), whole.root_uv(s));
    const size_t to = part.first_point(i), from = whole.first_point(s);
    for (size_t p = 0; p < part.strand_points(i); ++p) {
      for (int key = 0; key < part.motion_keys(); ++key) {
        ASSERT_EQ(part.point(to + p, key), whole.point(from + p, key));
        ASSERT_EQ(part.radius(to + p, key), whole.radius(from + p, key) * kept.width[i]);
      }
    }
    for (size_t a = 0; a < part.attributes().size(); ++a) {
      const StrandAttribute& of_part = part.attributes()[a];
      const StrandAttribute& of_whole = whole.attributes()[a];
      ASSERT_EQ(of_part.frequency, of_whole.frequency);
      const auto n = static_cast<size_t>(of_whole.components);
      const bool points = of_whole.frequency == AttributeClass::kPerPoint;
      const bool constant = of_whole.frequency == AttributeClass::kConstant;
      for (size_t c = 0; c < n * (points ? part.strand_points(i) : 1); ++c) {
        ASSERT_EQ(of_part.values[constant ? c : (points ? to : i) * n + c],
                  of_whole.values[constant ? c : (points ? from : s) * n + c]);
      }
    }
  }
}

}  // namespace pelage
