// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "world/frame_characters.h"

namespace pelage {

/// Returns RenderScene::origin of a frame, in world space. Returns 0 unless the coat that is nearest to the
/// camera is so far from the world's origin that floats would not resolve the widths of its strands. The
/// result then is a point near this coat, on a coarse grid, so that it seldom changes between frames. In a
/// scene without coats of its own, the same holds for the coats of its RIB files, which are read. `eye`: the
/// position of the camera. Throws the errors of load_archive().
V3f scene_origin(const SceneDescription& scene, Assets& assets, const std::vector<FrameCharacter>& characters,
                 const V3f& eye, double frame, const Job& job);

/// Returns a warning if the coat that is nearest to the camera is so far from the world's origin, in the
/// scene or in the file of its mesh, that the floats of its position change the picture.
std::optional<std::string> coarse_position(const SceneDescription& scene, const Assets& assets, double frame);

}  // namespace pelage
