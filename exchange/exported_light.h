// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/vector.h"
#include "exchange/export_notes.h"
#include "geom/mesh.h"
#include "world/scene_schema.h"

namespace pelage {

/// A light of the scene at one frame, in the terms that other renderers share.
struct ExportedLight {
  enum class Kind { kRectangle, kDisk, kSphere, kSpot, kSun, kMesh, kEnvironment };
  Kind kind = Kind::kSphere;
  std::string name;
  /// Everything that multiplies the image, or the radiance itself. Of kSpot: on the axis.
  Rgb radiance{0};
  V3f position{0};
  /// Unit vectors of a right-handed frame, and the light shines along z. kSun: z is where the light travels.
  V3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  V2f size{1, 1};          ///< kRectangle: along x and y
  float radius = 1;        ///< kDisk, kSphere, kSpot
  float angle = 0;         ///< degrees; kSun: diameter of the disk; kSpot: half angle of the cone
  float softness = 0;      ///< kSpot: fraction of the angle over which the light fades
  bool two_sided = false;  ///< kRectangle
  bool visible = false;    ///< to the camera
  bool shadows = true;
  std::string image;  ///< file of kRectangle, kSpot (a gobo) and kEnvironment; empty: none
  M44f rotation;      ///< kEnvironment: for row vectors
  ControlMesh mesh;   ///< kMesh, in world space
};

/// Returns the lights of a scene at a frame. Notes what is lost in all formats: lights that illuminate only
/// some parts, or have shadows of only some parts. `factor`: of all radiances. Throws Error (kInput) when a
/// light has no direction at this frame, or its mesh cannot be read.
std::vector<ExportedLight> exported_lights(const SceneDescription& scene, double frame, float factor,
                                           ExportNotes& notes);

/// Returns the matrix, for row vectors, from a space in which the light shines along -z to the world.
M44f light_to_world(const ExportedLight& light);

}  // namespace pelage
