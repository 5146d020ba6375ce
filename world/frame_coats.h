// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/job.h"
#include "groom/groom.h"
#include "lod/simplification.h"
#include "procedurals/detail/coat_direction.h"
#include "procedurals/skin/posed_character_skin.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// A skin of a character in a frame. `cages` has one cage per motion key, in world space.
struct FrameSkin {
  std::string name;  ///< "rat.body"
  std::string skin;  ///< key in SceneDescription::skins
  std::string material;
  Rgb tint{1};
  PosedCages cages;
  bool at_rest = false;  ///< whether all cages are the cage at rest
  std::shared_ptr<const PosedCharacterSkin> posed;
};

/// A coat of a character in a frame.
struct FrameCoat {
  std::string character, groom;  ///< "rat", "under"; animals of a crowd are "colony.17"
  std::string material;
  Rgb tint{1};
  std::shared_ptr<const Groom> coat;
  std::shared_ptr<const PosedCharacterSkin> skin;
  std::shared_ptr<const LimitSurface> rest;  ///< the skin at rest
  bool at_rest = false;                      ///< whether `skin` is in this pose at all motion keys
  std::optional<Simplification> lod;         ///< by `render.lod` and its camera; empty: full detail
  std::shared_ptr<const CoatDirection> direction;
  int64_t strands() const { return static_cast<int64_t>(coat->follicles().size()); }
};

/// The skins and coats of one frame, in the order of the scene.
struct FrameParts {
  std::vector<FrameSkin> skins;
  std::vector<FrameCoat> coats;
  CameraParams camera;  ///< focused_camera()
};

/// Poses the characters of a frame like compose(), but without materials and lights. `only`: the names of
/// the characters to pose; empty: all. Throws Error: kInput for missing or damaged poses, kStopped when the
/// job is stopped.
FrameParts pose_frame(const SceneDescription& scene, const Assets& assets, double frame, const Job& job,
                      const std::set<std::string>& only = {});

/// Returns the level of detail of a coat where the picture has `pixels_per_unit` everywhere, by the rule of
/// `render.lod` but without regard to motion, focus and facing, for which only a camera has values.
/// `workers`: for measuring properties of the coat.
Simplification scale_detail(const FrameCoat& coat, SimplificationParams params, float pixels_per_unit,
                            const Workers& workers);

/// Returns the times of the motion keys of a part with this number of keys: evenly spaced over the shutter,
/// in frames relative to the frame.
std::vector<float> motion_times(const CameraParams& camera, int keys);

}  // namespace pelage
