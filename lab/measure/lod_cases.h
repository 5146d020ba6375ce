// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "world/scene_schema.h"

namespace pelage {

/// Scene keys and their values, as --set wants them.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// A way to see the scene.
struct LodPlace {
  std::string id, title;
  Settings view;  ///< camera
};
/// A way to reduce its detail.
struct LodSetting {
  std::string id, title;
  Settings lod;         ///< `render.lod`
  bool reduced = true;  ///< false: full detail
};

/// The scene as it is, and from further away, with more blur, with a wider lens; the first is the scene.
std::vector<LodPlace> lod_places(const SceneDescription& scene);
/// Everything, then idea by idea.
std::vector<LodSetting> lod_ideas();
/// Full detail of coats that differ in their seeds alone: what it costs that other hairs are seen.
LodSetting other_hairs(const SceneDescription& scene);
/// From coarse to fine: `quality`.
std::vector<LodSetting> lod_qualities();
/// The camera of the detail stands still at `factor` of its distance, with the shutter and the lens of the
/// camera of the picture, which stays.
Settings detail_camera(const SceneDescription& scene, float factor);

}  // namespace pelage
