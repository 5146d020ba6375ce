// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Scene keys and their values, in the form of --set.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// A view of the scene.
struct LodPlace {
  std::string id, title;
  Settings view;  ///< camera
};
/// A way to reduce the detail of the scene.
struct LodSetting {
  std::string id, title;
  Settings lod;         ///< `render.lod`
  bool reduced = true;  ///< false: full detail
};

/// The unchanged scene, then the scene from farther away, with more blur, and with a wider lens.
std::vector<LodPlace> lod_places(const SceneDescription& scene);
/// A setting with all criteria, then one for each criterion alone.
std::vector<LodSetting> lod_ideas();
/// Full detail with other seeds for the coats. It shows how much a picture changes if only the individual
/// hairs differ.
LodSetting other_hairs(const SceneDescription& scene);
/// Values of `quality`, from coarse to fine.
std::vector<LodSetting> lod_qualities();
/// Moves the LOD camera to `factor` times its distance. The LOD camera has the shutter and lens of the
/// picture's camera, which does not move.
Settings detail_camera(const SceneDescription& scene, float factor);

}  // namespace pelage
