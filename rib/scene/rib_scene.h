// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/vector.h"
#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "geom/strand_counts.h"
#include "geom/strand_scale.h"
#include "geom/strands.h"
#include "rib/syntax/rib_transform.h"

namespace pelage {

/// A named parameter of a shader or an option, copied out of its request.
struct RibSetting {
  std::string name;
  std::string type;  ///< "float", "color", "string"
  SourcePosition position;
  bool is_array = false;
  std::vector<float> numbers;
  std::vector<std::string> strings;
};

/// A shader of the requests Surface, Bxdf, Pattern, LightSource, AreaLightSource and Light.
struct RibShader {
  std::string name;  ///< of its type: "plastic", "PxrMarschnerHair"
  SourcePosition position;
  std::vector<RibSetting> settings;
  const RibSetting* find(std::string_view wanted) const;
};

/// How a surface or a coat looks: its shader, or only the values of Color if it has none.
struct RibMaterial {
  std::string name;  ///< unique within a file: the parameter "name" or "__name" of the shader, or its name
  std::shared_ptr<const RibShader> shader;  ///< null without Surface
  Rgb color{1};
  bool fibre = false;           ///< on curves
  bool strand_color = false;    ///< the curves have the attribute "color"
  float opacity = 1;            ///< mean of the channels of Opacity
  bool strand_opacity = false;  ///< the curves have the attribute "opacity", a factor of `opacity`
};

/// Returns the name that a material gets in our scene if the first frame has another material of the same
/// `name`. `frame`: the frame of the material.
inline std::string frame_material(const std::string& name, int frame) {
  return name + "@" + std::to_string(frame);
}

/// A light with its transform from light to world space.
struct RibLight {
  enum class Shape { kPoint, kSphere, kPolygon, kMesh };
  std::string name;
  std::shared_ptr<const RibShader> shader;
  RibTransform to_world;
  Shape shape = Shape::kPoint;  ///< the first primitive of an area light; kPoint for the others
  float radius = 1;             ///< of a sphere
  std::vector<V3f> corners;     ///< of a polygon, in world space
  bool is_ris = false;          ///< stated by the request Light, which has shapes of its own
  bool visible = false;         ///< whether cameras see the light; only of the request Light
  std::filesystem::path map;    ///< image of an environment, absolute; empty without one
};

/// Strands that are read when they are needed: batch `batch` of an archive.
struct RibDeferredBatch {
  std::shared_ptr<const struct RibDeferredArchive> archive;
  size_t batch = 0;
  StrandCounts counts;
  Box3f box;  ///< exact, at all motion keys
};

/// The strands that share a name and a material.
struct RibCoat {
  std::string name;
  size_t material = 0;
  Rgb tint{1};
  std::vector<std::shared_ptr<const Strands>> batches;
  std::vector<RibDeferredBatch> deferred;
  StrandScale scale;
};

/// A request Procedural that asks for the plugin libpelage_ri.so or the program `pelage procedural`. Pelage
/// does not run them. The module world/ interprets the arguments and grows the coats itself.
struct RibOwnProcedural {
  std::string arguments;
  SourcePosition position;
  std::filesystem::path folder;  ///< of the file that was given first
  size_t material = 0;
  Rgb tint{1};
  RibTransform to_world;
};

/// A mesh with its positions at evenly spaced times from shutter open to close.
struct RibSkin {
  std::string name;
  size_t material = 0;
  Rgb tint{1};
  SourcePosition position;
  ControlMesh cage;  ///< with the positions at rest if the file has them, or else those at shutter open
  SubdivisionScheme scheme = SubdivisionScheme::kNone;
  BoundaryRule boundary = BoundaryRule::kEdgeAndCorner;
  std::vector<std::vector<V3f>> keys;
};

/// The camera and the picture of one frame.
struct RibCamera {
  bool stated = false;       ///< whether the file has a camera: a request Projection or WorldBegin
  RibTransform to_camera;    ///< world to camera space
  bool perspective = false;  ///< false: orthographic, which is the default of RI
  float fov = 90;            ///< degrees
  std::optional<std::array<float, 4>> screen_window;
  std::optional<V2f> shutter;
  std::optional<V3f> lens;  ///< f-stop, focal length, focal distance
  std::optional<std::pair<int, int>> format;
  std::optional<float> pixel_aspect, frame_aspect;
  std::optional<V2f> pixel_samples;
  float gain = 1;  ///< of Exposure
  std::string display;
  bool draws_depths = false;  ///< the display is a shadow map
};

/// Everything that one frame of a RIB file describes, in world space.
struct RibScene {
  std::optional<int>
      frame;  ///< number of the frame that was read; nullopt: the file has no frames, or not this
  bool shadow_pass = false;  ///< the frame draws shadow maps only
  RibCamera camera;
  std::map<std::string, std::vector<RibSetting>> options;  ///< Option "pelage", by the name of the setting
  std::vector<RibMaterial> materials;
  std::vector<RibLight> lights;
  std::vector<RibCoat> coats;
  std::vector<RibOwnProcedural> own_procedurals;
  std::vector<RibSkin> skins;
  std::set<std::filesystem::path> files;  ///< all files that were read
  std::vector<Problem> warnings;
};

}  // namespace pelage
