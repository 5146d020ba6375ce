// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/vector.h"
#include "rib/syntax/rib_writer.h"
#include "world/scene_schema.h"

namespace pelage {

/// Writes everything that RI sets before WorldBegin: Format, PixelSamples, Shutter, Clipping, Exposure,
/// DepthOfField, ScreenWindow, Projection, Display, Quantize, and the transform from world to camera space,
/// in a motion block if the camera moves. Times are in frames relative to the frame.
///
/// `content`: a box around everything in the scene, for Clipping. `picture`: name of the EXR file for
/// Display. `camera`: focused_camera() of the scene. The field of view is that at the time of the frame,
/// because RI has no motion of Projection. RI has no curve of the shutter.
void write_camera(RibWriter& rib, const SceneDescription& scene, const CameraParams& camera, double frame,
                  const Box3f& content, const std::string& picture);

}  // namespace pelage
