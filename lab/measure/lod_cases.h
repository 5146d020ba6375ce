// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Scene keys and their values, as for --set.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// A view of the scene.
struct LodPlace {
  std::string id, title;
  Settings view;  ///< keys of the camera
};
/// A way to reduce the detail of the scene, or full detail.
struct LodSetting {
  std::string id, title;
  Settings lod;         ///< keys of `render.lod`
  bool reduced = true;  ///< false: full detail
};

/// Returns views of the scene: the unchanged view, then views from twice and four times the distance. If the
/// shutter is open for some time, adds a view without motion blur and one with twice the shutter time. If the
/// camera has a lens, adds views with a lens a quarter as wide and twice as wide.
std::vector<LodPlace> lod_places(const SceneDescription& scene);
/// Returns a setting with all criteria and one with size alone. The following settings add one more criterion
/// each. The last setting has all criteria, but does not widen the remaining strands.
std::vector<LodSetting> lod_ideas();
/// Returns full detail with other seeds for the coats. This shows how much a picture changes if only the
/// individual strands differ.
LodSetting other_hairs(const SceneDescription& scene);
/// Returns settings with different values of `render.lod.quality`, from coarse to fine.
std::vector<LodSetting> lod_qualities();
/// Returns keys for a LOD camera at `factor` times the distance of the picture's camera, which does not move.
/// Both cameras have the same shutter and lens; the LOD camera stays focused on the same target.
Settings detail_camera(const SceneDescription& scene, float factor);

}  // namespace pelage
