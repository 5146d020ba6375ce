// SPDX-License-Identifier: Apache-2.0
#include "geom/strands.h"

#include <cstdio>
#include <utility>

#include "base/error.h"
#include "geom/curve_bounds.h"

/// Two straight hairs of width 0.2 along y, and the box that holds them.
int main() try {
  pelage::StrandArrays arrays;
  for (float x : {0.0f, 3.0f}) {
    arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
    arrays.ids.push_back(arrays.ids.size());
    for (float y : {0.0f, 1.0f, 2.0f}) arrays.points.insert(arrays.points.end(), {x, y, 0.0f, 0.1f});
  }
  arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));

  const pelage::Strands strands(std::move(arrays));
  const pelage::Box3f box = pelage::exact_bounds(strands);
  std::printf("%zu strands, %zu points, box %.3f %.3f %.3f to %.3f %.3f %.3f\n", strands.strand_count(),
              strands.point_count(), box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z);
} catch (const pelage::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
