// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_counts.h"

#include "geom/strands.h"

namespace pelage {

StrandCounts counts_of(const Strands& strands) {
  StrandCounts counts;
  counts.strands = strands.strand_count();
  counts.points = strands.point_count();
  counts.motion_keys = static_cast<size_t>(strands.motion_keys());
  for (size_t i = 0; i < counts.strands; ++i) {
    counts.segments += segment_count(strands.basis(), strands.strand_points(i));
    counts.longest = std::max<size_t>(counts.longest, strands.strand_points(i));
  }
  for (const StrandAttribute& a : strands.attributes()) counts.attribute_floats += a.values.size();
  return counts;
}

}  // namespace pelage
