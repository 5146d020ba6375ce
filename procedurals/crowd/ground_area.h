// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

/// Values of the keys of a level rectangle of ground.
struct RectangleAreaParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "rectangle";
  V3f center{0};
  V2f size{100, 100};  ///< lengths of the sides along x and z, before the rotation
  float rotate = 0;    ///< degrees about y
  static const Schema<RectangleAreaParams>& schema();
};
/// Values of the keys of a level disc of ground.
struct DiscAreaParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "disc";
  V3f center{0};
  float radius = 50;
  static const Schema<DiscAreaParams>& schema();
};
/// Values of the keys of a level polygon of ground.
struct PolygonAreaParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "polygon";
  std::vector<V2f> points;  ///< (x, z), in order around the border
  float height = 0;
  static const Schema<PolygonAreaParams>& schema();
};
using AreaParams = std::variant<RectangleAreaParams, DiscAreaParams, PolygonAreaParams>;

/// A level area of ground of any of these shapes. Points are (x, z), in world space. Immutable.
class GroundArea {
 public:
  explicit GroundArea(const AreaParams& params);

  bool contains(const V2f& point) const;
  /// Returns the point of the area that is nearest to `point`.
  V2f nearest(const V2f& point) const;
  /// Smallest and largest x and z of the area.
  V2f min() const { return min_; }
  V2f max() const { return max_; }
  double surface() const { return surface_; }  ///< area in square scene units
  double border() const { return border_; }    ///< length of the border
  float height() const { return height_; }     ///< y of the ground

 private:
  std::vector<V2f> outline_;  // empty for a disc
  V2f center_{0}, min_{0}, max_{0};
  float radius_ = 0, height_ = 0;
  double surface_ = 0, border_ = 0;
};

}  // namespace pelage
