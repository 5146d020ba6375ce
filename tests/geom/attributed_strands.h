// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/geom/random_strands.h"

namespace pelage {

/// Returns the attribute of this name. The test fails if there is none.
inline const StrandAttribute& attribute_of(const StrandArrays& a, const std::string& name) {
  const auto found = std::find_if(a.attributes.begin(), a.attributes.end(),
                                  [&](const StrandAttribute& one) { return one.name == name; });
  EXPECT_NE(found, a.attributes.end()) << name;
  static const StrandAttribute kNone;
  return found == a.attributes.end() ? kNone : *found;
}

/// 40 random strands with texture coordinates of their roots and an attribute of each class: "color",
/// "length" and "clump:size".
inline StrandArrays attributed_strands(CurveBasis basis) {
  RandomStrandOptions options;
  options.strands = 40;
  options.min_points = basis == CurveBasis::kBSpline ? 4 : 2;
  options.basis = basis;
  StrandArrays a = random_strands(7, options).arrays();
  const size_t points = a.points.size() / 4, strands = a.ids.size();
  StrandAttribute color{"color", AttributeClass::kPerPoint, 3, {}},
      length{"length", AttributeClass::kPerStrand, 1, {}};
  for (size_t i = 0; i < 3 * points; ++i) color.values.push_back(0.1f + 1e-3f * static_cast<float>(i));
  for (size_t i = 0; i < strands; ++i) {
    length.values.push_back(1.0f / static_cast<float>(i + 1));
    a.root_uv.emplace_back(0.1f * static_cast<float>(i), 1 / 3.0f);
  }
  a.attributes = {color, length, {"clump:size", AttributeClass::kConstant, 2, {1.5f, 1e-20f}}};
  return a;
}

}  // namespace pelage
