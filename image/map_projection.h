// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "image/map_field.h"

namespace pelage {

/// Where a projection looks a map up, and how much this lookup counts.
struct MapLookup {
  float u = 0, v = 0;
  float weight = 1;
};

/// Computes the coordinates of a map from a point of the rest skin. `center` and `size`: of the box that the
/// image covers; each component of `size` is > 0.
class Projector {
 public:
  Projector(MapProjection kind, MapAxis axis, const V3f& center, const V3f& size)
      : kind_(kind), axis_(static_cast<int>(axis)), center_(center), size_(size) {}

  /// Writes at most three lookups, whose weights sum to 1, and returns their number.
  size_t lookups(const FieldPoint& point, std::array<MapLookup, 3>& out) const;

 private:
  MapLookup planar(const V3f& at, int axis) const;
  MapLookup around(const V3f& at) const;

  MapProjection kind_;
  int axis_;
  V3f center_, size_;
};

}  // namespace pelage
