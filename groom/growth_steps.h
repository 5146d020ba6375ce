// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "geom/strands.h"

namespace pelage {

/// A strand after one step of its growth, as Groom::grow_steps() returns it.
struct GrowthStep {
  std::string name;  ///< "follicle" before the first operator, otherwise the name of the operator
  Strands strand;    ///< one strand with one motion key, in world space; at the last step, as grow() makes it
};

}  // namespace pelage
