// SPDX-License-Identifier: Apache-2.0
#include "geom/rest_position.h"

namespace pelage {

std::optional<V3f> rest_position(const Strands& strands, size_t strand) {
  const StrandAttribute* rest = strands.find_attribute(kRestPositions);
  if (!rest || rest->components != 3) return {};
  const size_t at = rest->frequency == AttributeClass::kConstant    ? 0
                    : rest->frequency == AttributeClass::kPerStrand ? strand
                                                                    : strands.first_point(strand);
  const float* p = &rest->values[3 * at];
  return V3f(p[0], p[1], p[2]);
}

}  // namespace pelage
