// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/keyed.h"
#include "base/value_readers.h"
#include "geom/limit_surface.h"
#include "groom/groom_params.h"
#include "procedurals/crowd.h"
#include "render/camera/camera.h"
#include "render/film/film_layers.h"
#include "render/light/light_params.h"
#include "render/material/material.h"
#include "render/scene/render_params.h"
#include "scene/document.h"
#include "world/frames.h"

namespace pelage {

// The scene file as one value; docs/MANUAL.md has its keys. A block that belongs to another room is described
// in that room.

/// `pelage:`, the version of the scene format.
struct FormatVersion {
  int number = 1;
};
template <>
struct ValueReader<FormatVersion> {
  static bool read(const Value&, const KeyOptions&, FormatVersion& out, Problems&);
  static std::string type_name() { return "1"; }
  static std::string print(const FormatVersion&) { return "1"; }
};

struct UnitsParams {
  float meters_per_unit = 0.01f;
  float fps = 24;
  static const Schema<UnitsParams>& schema();
};

/// A posed cage per frame, or one every few frames. Character frame `first` shows pose `first`; positions are
/// interpolated linearly between poses.
struct PosesParams {
  AssetPath files;  ///< with a placeholder for the number, see world/frames.h
  int first = 1;
  int count = 1;
  double frames_per_pose = 1;
  bool cycle = false;  ///< pose `first` follows the last pose again; else the first and last poses hold
  static const Schema<PosesParams>& schema();
};

struct SkinParams {
  AssetPath mesh;
  SubdivisionScheme scheme = SubdivisionScheme::kCatmullClark;
  BoundaryRule boundary = BoundaryRule::kEdgeAndCorner;
  std::optional<PosesParams> poses;
  static const Schema<SkinParams>& schema();
};

/// One skin of a character and the grooms that grow on it.
struct PartParams {
  NameReference skin;
  NameReference material;
  Named<NameReference> grooms;       ///< name of a groom -> name of its material
  std::optional<PosesParams> poses;  ///< instead of the skin's poses
  static const Schema<PartParams>& schema();
};

/// Scale first, then rotation, then translation.
struct TransformParams {
  Keyed<V3f> translate{V3f(0)};
  Keyed<V3f> rotate{V3f(0)};  ///< degrees about x, y, z, in this order
  Keyed<float> scale{1.0f};
  static const Schema<TransformParams>& schema();
};

struct CharacterParams {
  std::vector<PartParams> parts;
  TransformParams transform;
  float frame_offset = 0;     ///< added to the frame to get the pose
  Footprint footprint;        ///< discs (x, z, radius) on the ground, of an animal of scale 1
  std::optional<bool> drawn;  ///< empty: drawn unless a crowd uses it
  static const Schema<CharacterParams>& schema();
};

/// Everything that a scene file states.
struct SceneDescription {
  FormatVersion pelage;
  UnitsParams units;
  FrameList frames;
  CameraParams camera;
  ImageParams image;
  Named<SkinParams> skins;
  Named<GroomParams> grooms;
  Named<MaterialParams> materials;
  Named<CharacterParams> characters;
  Named<CrowdParams> crowds;
  Named<LightParams> lights;
  RenderParams render;
  std::string hash;  ///< hash of the document with its overrides, without the files that it names
  /// Every file from which the document was read: the scene and its includes. See asset_files() for the files
  /// that they name.
  std::vector<std::filesystem::path> files;
  std::vector<Problem> warnings;  ///< old names of keys in the document, each with the new one
  static const Schema<SceneDescription>& schema();
};

/// Adds a problem for every unknown name, with the nearest known one, and for every invalid combination: a
/// groom on a part with another skin, a fibre material on a skin.
void check_references(const SceneDescription& scene, Problems& problems);

/// Reads a scene and checks everything that can be checked without other files. Throws Error (kInput) with
/// all mistakes, in file order.
SceneDescription load_scene(const std::filesystem::path& path, const std::vector<Override>& overrides = {});

}  // namespace pelage
