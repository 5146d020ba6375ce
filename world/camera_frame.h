// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "world/assets.h"
#include "world/frame_characters.h"
#include "world/scene_schema.h"

namespace pelage {

/// The name in `camera.frame` that means all characters.
inline constexpr const char* kFrameAll = "all";

/// A ball that the picture must contain: a point of a skin, with the height of the fur above it.
struct FramedBall {
  V3f center{0};  ///< world space
  float radius = 0;
};

/// Returns the camera of a scene. Without `camera.frame`, this is `scene.camera`. Otherwise, the camera keeps
/// its direction, its up vector and its field of view, and is moved to the place where everything that
/// `frame` names fits into the picture with a margin of 5 % of its width or height: skins and their fur, of
/// which a few thousand strands are measured. The subject is in its pose at `scene.framed_at`, whichever
/// frames are rendered. If the direction or the field of view has keys, the camera is placed for each key. An
/// orthographic camera gets the height that fits. The result has no `frame`.
///
/// Throws Error: kInput if no visible character shows what `frame` names, kMemory if a pose does not fit.
CameraParams placed_camera(const SceneDescription& scene, const Assets& assets, const Job& job);

/// Returns the camera of one frame: `camera` (from placed_camera()) with the distance of what `focus_on`
/// names, which is the depth of the middle of its cages. `characters`: frame_characters(). Throws Error
/// (kInput) if no visible character shows it, or it is behind the camera.
CameraParams focused_camera(CameraParams camera, const Assets& assets,
                            std::span<const FrameCharacter> characters, double frame);

/// Places a camera of this direction so that the picture contains all balls, with the margin. See
/// placed_camera(). `aspect`: width of the picture divided by its height. A camera without a valid direction
/// is left alone; the class Camera refuses it.
CameraParams camera_around(std::span<const FramedBall> balls, CameraParams camera, double aspect);

/// Returns a three-quarter view for a scene with this up vector: the direction from the subject to the
/// camera, in front, to the right and a little above. The front is +z if y is up, and -y if z is up.
V3f default_view(const V3f& up);

}  // namespace pelage
