// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "base/keyed.h"
#include "base/ledger.h"
#include "base/value_readers.h"
#include "geom/io/file_transform.h"
#include "render/light/barn_doors.h"
#include "render/light/ies_file.h"
#include "render/light/light.h"
#include "render/light/light_emission.h"
#include "render/light/spread_grid.h"

namespace pelage {

class LightProfile;
class TextureLibrary;

// Lengths are in scene units, also in the units of radiance and irradiance. The radiance of a light is
// color() * strength() * unit_radiance(). If the light has a power, `radiance` is only a colour.

struct RectangleLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "rectangle";
  Keyed<V3f> position{V3f(0)};        ///< centre
  Keyed<V3f> look_at{V3f(0, 0, -1)};  ///< the emitting side faces this point
  V3f up{0, 1, 0};
  V2f size{1, 1};              ///< width, height
  std::optional<float> power;  ///< W
  bool two_sided = false;
  AssetPath file;      ///< image, a factor of the radiance; empty: 1
  float spread = 180;  ///< SpreadGrid
  std::optional<BarnDoors> barn_doors;
  float unit_radiance() const;
  static const Schema<RectangleLightParams>& schema();
};
struct DiskLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "disk";
  Keyed<V3f> position{V3f(0)};        ///< centre
  Keyed<V3f> look_at{V3f(0, 0, -1)};  ///< the emitting side faces this point
  float radius = 0.5f;
  std::optional<float> power;  ///< W
  float spread = 180;          ///< SpreadGrid
  float unit_radiance() const;
  static const Schema<DiskLightParams>& schema();
};
struct SphereLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "sphere";
  Keyed<V3f> position{V3f(0)};
  float radius = 1;
  std::optional<float> power;  ///< W
  float unit_radiance() const;
  static const Schema<SphereLightParams>& schema();
};
/// A small sphere, whose brightness does not depend on its radius.
struct PointLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "point";
  Keyed<V3f> position{V3f(0)};
  std::optional<Keyed<V3f>> look_at;  ///< on the axis of the profile; empty: straight down
  V3f up{0, 1, 0};                    ///< of the profile
  float radius = 0.05f;
  std::optional<float> power;  ///< W; empty: 100, or as the profile states
  AssetPath profile;           ///< SpotCone::profile; empty: none
  /// Reads the profile if it states the power, and then throws Error (kInput) as read_ies() does.
  float unit_radiance() const;
  /// The same with the profile, which has been read; null: there is none.
  float unit_radiance(const LightProfile* read) const;
  static const Schema<PointLightParams>& schema();
};
/// See SpotLight.
struct SpotLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "spot";
  Keyed<V3f> position{V3f(0)};
  Keyed<V3f> look_at{V3f(0, 0, -1)};
  V3f up{0, 1, 0};  ///< of the gobo and the profile
  float radius = 0.05f;
  std::optional<float> power;  ///< W, of the lamp without its cone; empty: 100, or as the profile states
  float cone = 40;             ///< whole angle in degrees
  float softness = 0.2f;       ///< SpotCone::softness
  AssetPath file;              ///< SpotCone::gobo; empty: none
  AssetPath profile;           ///< SpotCone::profile; empty: none
  /// Of the whole sphere, as PointLightParams::unit_radiance().
  float unit_radiance() const;
  float unit_radiance(const LightProfile* read) const;
  static const Schema<SpotLightParams>& schema();
};
struct SunLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "sun";
  Keyed<V3f> direction{V3f(0, -1, 0)};  ///< in which the light travels, of any length
  float angle = 0.53f;                  ///< diameter of the disk in degrees
  std::optional<float> irradiance;      ///< W/m2, on a surface that faces the sun
  float unit_radiance() const;
  static const Schema<SunLightParams>& schema();
};
/// See MeshLight.
struct MeshLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "mesh";
  AssetPath file;  ///< OBJ
  FileTransformParams transform;
  std::optional<float> power;  ///< W; make_light() divides it by the area of the mesh
  float unit_radiance() const { return 1; }
  static const Schema<MeshLightParams>& schema();
};
struct EnvironmentLightParams : LightEmission {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "environment";
  EnvironmentLightParams() { visible = true; }
  AssetPath file;  ///< lat-long image, a factor of the radiance, see EnvironmentMap; empty: 1
  V3f rotate{0};   ///< rotation about x, then y, then z, in degrees
  float unit_radiance() const { return 1; }
  static const Schema<EnvironmentLightParams>& schema();
};
using LightParams = std::variant<RectangleLightParams, DiskLightParams, SphereLightParams, PointLightParams,
                                 SpotLightParams, SunLightParams, MeshLightParams, EnvironmentLightParams>;

/// Returns the unit radiance of a light that has no spread but the same power, for renderers without spread.
template <class Params>
float radiance_without_spread(const Params& p) {
  if constexpr (requires { p.spread; })
    return p.unit_radiance() * static_cast<float>(SpreadGrid(p.spread).passed_fraction());
  else
    return p.unit_radiance();
}

/// Reads the profile of a point or a spot. Throws Error (kInput) as read_ies() does, at the place of the
/// scene if the file cannot be read.
IesPhotometry read_profile(const AssetPath& file);

/// Makes a light with its parameters at `frame`. `origin`: RenderScene::origin. Does not resolve the names of
/// characters and coats. Throws Error (kInput) for missing images and
/// profiles, and for directions of length 0.
std::unique_ptr<Light> make_light(const std::string& name, const LightParams& params, double frame,
                                  TextureLibrary& textures, MemoryLedger& ledger, const V3f& origin = V3f(0));

}  // namespace pelage
