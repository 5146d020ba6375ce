// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/value_readers.h"
#include "geom/strands.h"

namespace pelage {

template <>
struct EnumNames<CurveBasis> {
  static constexpr const char* names[] = {"linear", "pinned-b-spline", "b-spline", "catmull-rom"};
};

}  // namespace pelage
