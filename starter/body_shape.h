// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "base/vector.h"
#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "starter/scalp.h"

namespace pelage {

/// One of the six directions of the axes of a mesh.
struct AxisDirection {
  int axis = 0;  ///< 0 x, 1 y, 2 z
  float sign = 1;

  V3f vector() const;
  std::string name() const;  ///< "x", "-x" ...
  AxisDirection opposite() const { return {axis, -sign}; }
  bool operator==(const AxisDirection&) const = default;
};

/// Reads "x", "+x" or "-x" and the like. Empty for any other text.
std::optional<AxisDirection> parse_axis(std::string_view text);

inline float sphere_diameter(float area) { return std::sqrt(area / std::numbers::pi_v<float>); }

/// What the geometry of a mesh says about the animal. Lengths are in units of the mesh.
struct BodyShape {
  Box3f box;                 ///< of the vertices that faces use
  float area = 0;            ///< of the cage, each doubled face counted once
  size_t doubled_faces = 0;  ///< faces that have the same vertices as an earlier face
  AxisDirection up{1, 1};
  AxisDirection facing{2, 1};                                   ///< where the head is; a guess
  Scalp scalp;                                                  ///< if this is a person; a guess
  SubdivisionScheme scheme = SubdivisionScheme::kCatmullClark;  ///< that suits the mesh
  float meters_per_unit = 1;  ///< 1, 0.01 or 0.001: with which the body is nearest to 0.6 m long

  float extent(AxisDirection direction) const { return box.size()[direction.axis]; }
  /// Whether the body is clearly higher than long, like a penguin or a bust.
  bool is_upright() const { return extent(up) > 1.2f * extent(facing); }
  /// Diameter of the sphere with the same area: the length to which coats are scaled.
  float size() const { return sphere_diameter(area); }
};

/// Examines a mesh. `up` and `facing` replace the guesses; `facing` must not be along `up`.
///
/// The guesses: up is y, unless the mesh is mirror symmetric along y or stands much more broadly on its lower
/// end along z. The body lies along the horizontal axis that its mirror symmetry leaves, or along the longer
/// one if the symmetry does not decide. The head is at the end that is higher and has more vertices.
///
/// Throws Error (kInput) with `source` if the mesh has no area.
BodyShape body_shape(ControlMesh mesh, const std::string& source, std::optional<AxisDirection> up = {},
                     std::optional<AxisDirection> facing = {});

}  // namespace pelage
