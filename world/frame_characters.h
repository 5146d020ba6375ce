// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/vector.h"
#include "procedurals/skin/posed_character_skin.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// A character that is visible in the picture: a single character of the scene, or an animal of a crowd.
struct FrameCharacter {
  std::string name;       ///< "rat", or "colony.17" for an animal of a crowd, counted from 0
  std::string prototype;  ///< name of the character of the scene that it is or is copied from
  const CharacterParams* params = nullptr;  ///< parameters of the prototype
  std::optional<CrowdMember> member;        ///< only for an animal of a crowd
};

/// Returns all visible characters of a scene: first the single characters, then the animals of each crowd, in
/// the order of the scene. `scene` must outlive the result.
std::vector<FrameCharacter> frame_characters(const SceneDescription& scene, const Assets& assets);

/// Returns the memory in bytes that one animal of a crowd takes in a frame: its names, posed cages and
/// descriptions of its coats. `name` and `character`: the animal's prototype. The result does not include
/// grown strands and whole poses (class PoseCache).
int64_t frame_character_bytes(const SceneDescription& scene, const Assets& assets, const std::string& name,
                              const CharacterParams& character);

/// Returns whether the character has any groom.
bool has_coat(const FrameCharacter& character);

/// Returns whether a coat of a part of the character moves by `dynamics`.
bool has_dynamics(const FrameCharacter& character, size_t part, const Assets& assets);

/// Returns the box of the cage of one part of a character, in world space. For an animal of a crowd, the box
/// of the cage at rest, moved to its place.
Box3f approximate_box(const FrameCharacter& character, size_t part, const Assets& assets, double frame);

/// Returns the posed cages of one part of a character. If the part or a coat of it is animated and the
/// shutter is open for some time, these are one cage per motion key of the camera, and two cages at frame -
/// 1/2 and frame + 1/2. Otherwise there is one cage. If the part is animated, the result also has its motion
/// to the next frame. The cages are relative to `origin` (RenderScene::origin).
CharacterPose pose_character(const FrameCharacter& character, size_t part, const Assets& assets,
                             const CameraParams& camera, double frame, const V3f& origin = V3f(0));

/// Returns the cage of one part of a character at one time, in world space. `time`: a frame number.
std::vector<V3f> posed_cage(const FrameCharacter& character, size_t part, const Assets& assets, double time);

/// Returns the matrix M from the object space of a character to world space at a frame. Points are row
/// vectors: p * M. The matrix scales first, then rotates about x, y and z in this order, then translates.
/// The result is relative to `origin`.
M44f character_matrix(const TransformParams& transform, double frame, const V3f& origin = V3f(0));

/// Returns whether the transform is animated, because one of its values has at least two keys.
bool moves(const TransformParams& transform);

}  // namespace pelage
