// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "world/scene_schema.h"

namespace pelage {

/// Adds a problem for each name in `camera.frame` and `camera.focus_on` that no skin or character has, with
/// the nearest existing name, and for each of these keys in the camera of `lod`.
void check_camera_names(const SceneDescription& scene, Problems& problems);

/// Adds a problem for each key of the block `camera` that contradicts another one, at its place in
/// `document`.
void check_camera_keys(const SceneDescription& scene, const Value& document, Problems& problems);

}  // namespace pelage
