// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Returns scene keys and their values, as for --set, with which the scene has `count` frames, 2 or more,
/// from its first frame on. The camera starts where it is in the first frame and moves to its right, so that
/// its target moves by one pixel per frame. Its own movement is replaced; everything else moves as in the
/// scene.
std::vector<std::pair<std::string, std::string>> camera_pan(const SceneDescription& scene, int count);

/// Throws Error (kInput) if the camera has `frame`: moving it would change only the direction of the view.
void require_placed(const CameraParams& camera);

/// Returns the frames of camera_pan().
FrameList pan_frames(const SceneDescription& scene, int count);

}  // namespace pelage
