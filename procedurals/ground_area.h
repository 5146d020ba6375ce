// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

/// Shapes of level ground, as described by a scene.
struct RectangleAreaParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "rectangle";
  V3f center{0};
  V2f size{100, 100};  ///< along x and z before `rotate`
  float rotate = 0;    ///< degrees about y
  static const Schema<RectangleAreaParams>& schema();
};
struct DiscAreaParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "disc";
  V3f center{0};
  float radius = 50;
  static const Schema<DiscAreaParams>& schema();
};
struct PolygonAreaParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "polygon";
  std::vector<V2f> points;  ///< (x, z), in order around the border
  float height = 0;
  static const Schema<PolygonAreaParams>& schema();
};
using AreaParams = std::variant<RectangleAreaParams, DiscAreaParams, PolygonAreaParams>;

/// A ground area of any shape, ready for queries. Points are (x, z). Immutable.
class GroundArea {
 public:
  explicit GroundArea(const AreaParams& params);

  bool contains(const V2f& point) const;
  /// The point of the area nearest to `point`.
  V2f nearest(const V2f& point) const;
  /// Smallest and largest coordinates.
  V2f min() const { return min_; }
  V2f max() const { return max_; }
  double surface() const { return surface_; }
  double border() const { return border_; }  ///< length of the border
  float height() const { return height_; }

 private:
  std::vector<V2f> outline_;  // empty for a disc
  V2f center_{0}, min_{0}, max_{0};
  float radius_ = 0, height_ = 0;
  double surface_ = 0, border_ = 0;
};

}  // namespace pelage
