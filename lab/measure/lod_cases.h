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
/// A way to reduce its detail.
struct LodSetting {
  std::string id, title;
  Settings lod;         ///< `render.lod`
  bool reduced = true;  ///< false: full detail
};

/// The scene as it is, and from farther away, with more blur, with a wider lens; the first is the scene.
std::vector<LodPlace> lod_places(const SceneDescription& scene);
/// All criteria, then each separately.
std::vector<LodSetting> lod_ideas();
/// Full detail with coats that differ only in their seeds: the difference caused by seeing other hairs.
LodSetting other_hairs(const SceneDescription& scene);
/// Values of `quality`, from coarse to fine.
std::vector<LodSetting> lod_qualities();
/// Moves the LOD camera to `factor` of its distance, with the shutter and lens of the picture's camera, which
/// does not move.
Settings detail_camera(const SceneDescription& scene, float factor);

}  // namespace pelage
