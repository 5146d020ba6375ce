// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/keyed.h"
#include "base/value_readers.h"
#include "geom/io/file_transform.h"
#include "geom/limit_surface.h"
#include "groom/coat/groom_params.h"
#include "procedurals/crowd/crowd.h"
#include "render/camera/camera.h"
#include "render/film/film_layers.h"
#include "render/light/light_params.h"
#include "render/light/magnet_params.h"
#include "render/material/material.h"
#include "render/scene/render_params.h"
#include "rib/document/rib_use.h"
#include "scene/document.h"
#include "world/frames.h"
#include "world/scene_changes.h"

namespace pelage {

class GrowthCache;
class OperatorScripts;

// The contents of a scene file as one struct. docs/MANUAL.md describes the keys. Structs of blocks that
// belong to another folder, such as render/, are declared there.

/// Value of the key `pelage`: the version of the scene format.
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

/// A sequence of `count` posed cages. Pose `first` applies at frame `first` of the character, and each
/// further pose frames_per_pose frames later. Positions are interpolated linearly between poses.
struct PosesParams {
  AssetPath files;  ///< path with a placeholder for the file's number, see world/frames.h
  int first = 1;    ///< number of the first file
  int count = 1;
  double frames_per_pose = 1;
  bool cycle = false;  ///< true: the sequence repeats; false: the first pose also applies before, the last
                       ///< pose after the sequence
  static const Schema<PosesParams>& schema();
};

/// Name of the light layer of `image.background`.
inline constexpr const char* kBackground = "background";

/// Name of the skin without a surface, and of its material, that load_scene() gives to parts without a skin.
inline constexpr const char* kNoSkin = "(no skin)";

struct SkinParams {
  AssetPath mesh;  ///< empty: no surface (kNoSkin)
  SubdivisionScheme scheme = SubdivisionScheme::kCatmullClark;
  BoundaryRule boundary = BoundaryRule::kEdgeAndCorner;
  std::optional<PosesParams> poses;
  FileTransformParams transform;  ///< of the mesh and the poses
  static const Schema<SkinParams>& schema();
};

/// One skin of a character and the grooms that grow on it, or grooms without a skin.
struct PartParams {
  NameReference skin;                ///< kNoSkin: the grooms are strand files that follow no skin
  NameReference material;            ///< of the skin
  Named<NameReference> grooms;       ///< from the name of each groom to the name of its material
  std::optional<PosesParams> poses;  ///< empty: the poses of the skin
  static const Schema<PartParams>& schema();
};

/// Transform of a character: scales first, then rotates, then translates.
struct TransformParams {
  Keyed<V3f> translate{V3f(0)};
  Keyed<V3f> rotate{V3f(0)};  ///< degrees about x, y, z, in this order
  Keyed<float> scale{1.0f};
  static const Schema<TransformParams>& schema();
};

struct CharacterParams {
  std::vector<PartParams> parts;
  TransformParams transform;
  float frame_offset = 0;     ///< frame of the character = frame of the scene + this
  Footprint footprint;        ///< ground that an animal of scale 1 covers: discs (x, z, radius)
  std::optional<bool> drawn;  ///< whether it appears by itself; empty: only if no crowd uses it
  static const Schema<CharacterParams>& schema();
};

/// A RIB file, whose coats and skins are rendered as they are.
struct ArchiveParams {
  AssetPath rib;
  TransformParams transform;
  /// From the surfaces of the file, by name, to materials of the scene. load_scene() adds the surfaces that
  /// the scene does not mention, and materials for them.
  Named<NameReference> materials;
  static const Schema<ArchiveParams>& schema();
};

/// Everything that a scene file states.
struct SceneDescription {
  FormatVersion pelage;
  UnitsParams units;
  FrameList frames;
  CameraParams camera;  ///< as written; placed_camera() applies `frame`
  double framed_at =
      1;  ///< frame whose pose `camera.frame` fits: the first one of the file, not of overrides
  ImageParams image;
  Named<Field> regions;  ///< load_scene() has put them in the places of their names (world/regions.h)
  Named<SkinParams> skins;
  Named<GroomParams> grooms;
  Named<MaterialParams> materials;
  Named<CharacterParams> characters;
  Named<CrowdParams> crowds;
  Named<ArchiveParams> archives;
  Named<LightParams> lights;
  Named<MagnetParams> magnets;
  RenderParams render;
  std::string hash;  ///< hash of the document with its overrides, not of the assets that it names
  /// All files that this process reads for the scene: the scene file, its included files, and the assets
  /// (asset_files()).
  std::vector<std::filesystem::path> files;
  /// Overrides that are not given as values, as KEY=VALUE: for commands in messages.
  std::vector<std::string> settings;
  bool from_rib = false;                  ///< whether the scene is a RIB file (is_rib())
  std::shared_ptr<RibPrograms> programs;  ///< RibUse::programs
  SceneParts parts;                       ///< hashes of the parts of the document, to compare scenes
  /// One per use of an old name of a key, with the current name, and per setting without effect.
  std::vector<Problem> warnings;
  /// Where coats keep follicles between runs; null: nowhere. Set by the program, not by the document.
  std::shared_ptr<const GrowthCache> growth_cache;
  /// Runs the scripts of operators; null: a scene with such operators is an error. Set by the program, not by
  /// the document.
  std::shared_ptr<const OperatorScripts> scripts;
  static const Schema<SceneDescription>& schema();
};

/// Adds a problem for every reference to a name that does not exist, with the nearest existing name. Also
/// adds a problem for every invalid combination, such as a groom on a part with another skin, or a fibre
/// material on a skin.
void check_references(const SceneDescription& scene, Problems& problems);

/// Reads a scene file with its includes, or a RIB file (rib_document()), applies the overrides, and checks
/// everything that can be checked without the assets. Throws Error (kInput) with all mistakes, in the order
/// of the file. `use`: what the user states about its RIB files.
SceneDescription load_scene(const std::filesystem::path& path, const std::vector<Override>& overrides = {},
                            const RibUse& use = {});

/// Does the same with values that a host has made instead of a file (complete_document()). Positions of
/// values should have no line and, as file, the path of keys that leads to the value, "grooms.coat.strands".
SceneDescription make_scene(const Value& document, const std::vector<Override>& overrides = {});

}  // namespace pelage
