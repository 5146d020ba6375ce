// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/field_nodes.h"

// Fields of shapes in rest space, and of the skin at the root.

namespace pelage {

/// A direction in rest space, which a scene writes as x, y, z or as 3 numbers. Unit length.
struct FieldDirection {
  V3f direction{0, 1, 0};
};
template <>
struct ValueReader<FieldDirection> {
  static bool read(const Value&, const KeyOptions&, FieldDirection& out, Problems&);
  static std::string type_name() { return "x | y | z | 3 numbers"; }
  static std::string print(const FieldDirection& direction);
};

struct BoxShape {
  V3f size{1};
  std::optional<V3f> center;  ///< rest space; empty: the middle of the skin's bounds
  float soft = 0;             ///< width of the transition outside the box, scene units
};

struct SphereShape {
  float radius = 1;
  std::optional<V3f> center;
  float soft = 0;
};

/// Where a distance is measured from: a point, the plane through it, or a line through several points.
struct DistanceTarget {
  std::optional<V3f> point;
  std::optional<FieldDirection> plane;  ///< normal of the plane through `point`
  std::vector<V3f> line;                ///< at least 2 points, if there is no `point`
};

/// `position`: where the scene has the block, for the errors of with_textures().
Field box_field(BoxShape box, SourcePosition position);
Field sphere_field(SphereShape sphere, SourcePosition position);
/// Returns 0 at the lowest and 1 at the highest corner of the skin's bounds, along a direction.
Field height_field(FieldDirection up, SourcePosition position);
/// Returns the cosine of the angle between the skin's normal and a direction; 0 without a skin.
Field slope_field(FieldDirection up);
Field distance_field(DistanceTarget target);

/// Returns the bounds of the skin that a field is loaded for. Throws Error (kInput) if there is none.
Box3f bounds_for(const std::string& what, const SourcePosition& position, const FieldSources& sources);
/// Returns the skin that a field is loaded for. Throws Error (kInput) if there is none.
const FieldSkin& skin_for(const std::string& what, const SourcePosition& position,
                          const FieldSources& sources);

}  // namespace pelage
