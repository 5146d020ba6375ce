// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "base/place_of_file.h"
#include "geom/io/host_geometry.h"
#include "geom/io/mesh_file.h"
#include "geom/polygon_cut.h"
#include "image/texture_library.h"
#include "render/light/aim.h"
#include "render/light/disk_light.h"
#include "render/light/environment_light.h"
#include "render/light/light_params.h"
#include "render/light/mesh_light.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "render/light/spot_light.h"
#include "render/light/sun_light.h"
#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr float kRadians = std::numbers::pi_v<float> / 180;

/// Radiance of a surface that emits a power equally from every point in every direction.
float radiance_of(const std::optional<float>& power, float area) { return power ? *power / (kPi * area) : 1; }
float sphere_area(float radius) { return 4 * kPi * radius * radius; }

/// Radiance of a lamp, of which a profile may state the power.
float lamp_radiance(const std::optional<float>& power, const LightProfile* profile, float radius) {
  return radiance_of(power.value_or(profile ? profile->watts() : 100.0f), sphere_area(radius));
}

template <class Lamp>
float lamp_radiance(const Lamp& p) {
  if (p.power || p.profile.empty()) return p.unit_radiance(nullptr);
  const LightProfile profile(read_profile(p.profile));
  return p.unit_radiance(&profile);
}

std::vector<MeshLight::Triangle> triangles_of(ControlMesh cage, const M44f& to_scene) {
  transform_cage(to_scene, cage);
  std::vector<MeshLight::Triangle> triangles;
  std::vector<V3f> corners;
  std::vector<uint32_t> cut;
  std::set<std::vector<uint32_t>> known;  // faces, each from its smallest vertex on
  const uint32_t* vertex = cage.face_vertices.data();
  for (const uint32_t size : cage.face_sizes) {
    std::vector<uint32_t> face(vertex, vertex + size);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    if (!known.insert(std::move(face)).second) {  // light of a doubled face would be counted twice
      vertex += size;
      continue;
    }
    corners.clear();
    cut.clear();
    for (uint32_t i = 0; i < size; ++i) corners.push_back(cage.positions[vertex[i]]);
    cut_polygon({vertex, size}, corners, cut);
    for (size_t i = 0; i + 2 < cut.size(); i += 3)
      triangles.push_back({{corners[cut[i]], corners[cut[i + 1]], corners[cut[i + 2]]}});
    vertex += size;
  }
  return triangles;
}

struct LightMaker {
  const std::string& name;
  double frame;
  TextureLibrary& textures;
  MemoryLedger& ledger;
  const V3f& origin;

  std::unique_ptr<Light> operator()(const RectangleLightParams& p) const {
    const Aim axes = facing(p, p.up);
    const Rectangle shape{center(p), axes.x, axes.y, p.size * 0.5f};
    return std::make_unique<RectangleLight>(
        name, shape, radiance(p), p.two_sided, p.visible,
        RectangleShaping{image(p.file), SpreadGrid(p.spread), p.barn_doors.value_or(BarnDoors())});
  }

  std::unique_ptr<Light> operator()(const DiskLightParams& p) const {
    return std::make_unique<DiskLight>(name, center(p), facing(p, V3f(0, 1, 0)).z, p.radius, radiance(p),
                                       p.visible, SpreadGrid(p.spread));
  }

  std::unique_ptr<Light> operator()(const SphereLightParams& p) const {
    return std::make_unique<SphereLight>(name, center(p), p.radius, radiance(p), p.visible);
  }

  std::unique_ptr<Light> operator()(const PointLightParams& p) const {
    if (!p.profile.empty()) {
      const Aim axes = lamp_axes(p);
      SpotCone all{-axes.x, axes.y, axes.z, kPi, 0, nullptr, profile(p.profile)};
      const Rgb emitted = radiance(p, p.unit_radiance(all.profile.get()));
      return std::make_unique<SpotLight>(name, center(p), p.radius, std::move(all), emitted, p.visible);
    }
    return std::make_unique<SphereLight>(name, center(p), p.radius, radiance(p), p.visible);
  }

  std::unique_ptr<Light> operator()(const SpotLightParams& p) const {
    const Aim axes = facing(p, p.up);
    SpotCone cone{-axes.x,           axes.y, axes.z, 0.5f * p.cone * kRadians, p.softness, image(p.file),
                  profile(p.profile)};
    const Rgb emitted = radiance(p, p.unit_radiance(cone.profile.get()));
    return std::make_unique<SpotLight>(name, center(p), p.radius, std::move(cone), emitted, p.visible);
  }

  std::unique_ptr<Light> operator()(const SunLightParams& p) const {
    const V3f direction = p.direction.at(frame);
    if (!(direction.length() > 0)) refuse("direction has the length 0");
    const float half_angle = 0.5f * p.angle * kRadians;
    return std::make_unique<SunLight>(name, -direction.normalized(), half_angle, radiance(p), p.visible);
  }

  std::unique_ptr<Light> operator()(const MeshLightParams& p) const {
    std::vector<MeshLight::Triangle> triangles = with_place_of(p.file, [&] {
      return triangles_of(p.file.data ? host_mesh(p.file) : read_mesh_file(p.file.path),
                          p.transform.matrix());
    });
    double area = 0;
    for (MeshLight::Triangle& t : triangles) {
      for (V3f& corner : t.corners) corner -= origin;
      area += 0.5 * double{(t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).length()};
    }
    if (!(area > 0))
      throw Error(ErrorKind::kInput, p.file.position, quote(p.file.path.string()) + " has no area");
    const float unit = radiance_of(p.power, static_cast<float>(area));
    MemoryCharge charge = reserve(ledger, MemoryTag::kSkins, MeshLight::bytes(triangles.size()),
                                  "the triangles of the light " + name);
    return std::make_unique<MeshLight>(name, std::move(triangles), radiance(p) * unit, p.visible,
                                       std::move(charge));
  }

  std::unique_ptr<Light> operator()(const EnvironmentLightParams& p) const {
    const Rgb factor = radiance(p);
    if (p.file.empty()) return std::make_unique<EnvironmentLight>(name, factor, p.visible);
    return with_place_of(p.file, [&]() -> std::unique_ptr<Light> {
      return std::make_unique<EnvironmentLight>(name, image(p.file), factor, rotation_xyz(p.rotate),
                                                p.visible, ledger, [this] { textures.check_stop(); });
    });
  }

 private:
  [[noreturn]] void refuse(const char* what) const {
    throw Error(ErrorKind::kInput, fmt::format("lights.{}: {} at frame {}", name, what, frame));
  }

  template <class Params>
  V3f center(const Params& p) const {
    return relative_to(p.position, origin).at(frame);
  }

  template <class Params>
  Aim facing(const Params& p, const V3f& up) const {
    const std::optional<Aim> aim = Aim::at(center(p), relative_to(p.look_at, origin).at(frame), up);
    if (!aim) refuse("position and look_at are the same point");
    return *aim;
  }

  /// The axes of the profile of a point.
  Aim lamp_axes(const PointLightParams& p) const {
    const V3f at = center(p);
    const V3f to = p.look_at ? relative_to(*p.look_at, origin).at(frame) : at - V3f(0, 1, 0);
    const V3f forward = to - at;
    const bool along_up = !(p.up.cross(forward).length() > 1e-6f * p.up.length() * forward.length());
    const std::optional<Aim> aim = Aim::at(at, to, along_up ? V3f(0, 0, -1) : p.up);
    if (!aim) refuse("position and look_at are the same point");
    return *aim;
  }

  std::shared_ptr<const LightProfile> profile(const AssetPath& file) const {
    if (file.empty()) return nullptr;
    IesPhotometry ies = read_profile(file);
    MemoryCharge charge =
        reserve(ledger, MemoryTag::kTextures, LightProfile::bytes(ies), "the profile of the light " + name);
    return std::make_shared<const LightProfile>(std::move(ies), std::move(charge));
  }

  template <class Params>
  Rgb radiance(const Params& p) const {
    return radiance(p, p.unit_radiance());
  }
  Rgb radiance(const LightEmission& p, float unit) const { return p.color() * (p.strength(frame) * unit); }

  std::shared_ptr<const Texture> image(const AssetPath& file) const {
    if (file.empty()) return nullptr;
    return with_place_of(file, [&] { return textures.load(file, ColorSpace::kAuto); });
  }
};

}  // namespace

IesPhotometry read_profile(const AssetPath& file) {
  return with_place_of(file, [&] {
    if (file.data) throw Error(ErrorKind::kInput, "a profile must be a file");
    return read_ies(file.path);
  });
}

float RectangleLightParams::unit_radiance() const {
  const float area = (two_sided ? 2.0f : 1.0f) * size.x * size.y;
  return radiance_of(power, area * static_cast<float>(SpreadGrid(spread).passed_fraction()));
}
float DiskLightParams::unit_radiance() const {
  return radiance_of(power, kPi * radius * radius * static_cast<float>(SpreadGrid(spread).passed_fraction()));
}
float SphereLightParams::unit_radiance() const { return radiance_of(power, sphere_area(radius)); }
float PointLightParams::unit_radiance() const { return lamp_radiance(*this); }
float PointLightParams::unit_radiance(const LightProfile* read) const {
  return lamp_radiance(power, read, radius);
}
float SpotLightParams::unit_radiance() const { return lamp_radiance(*this); }
float SpotLightParams::unit_radiance(const LightProfile* read) const {
  return lamp_radiance(power, read, radius);
}
float SunLightParams::unit_radiance() const {
  const double sine = std::sin(0.5 * double{angle} * kRadians);
  return irradiance ? static_cast<float>(*irradiance / (std::numbers::pi * sine * sine)) : 1.0f;
}

std::unique_ptr<Light> make_light(const std::string& name, const LightParams& params, double frame,
                                  TextureLibrary& textures, MemoryLedger& ledger, const V3f& origin) {
  std::unique_ptr<Light> light = std::visit(LightMaker{name, frame, textures, ledger, origin}, params);
  if (!std::visit([](const LightEmission& p) { return p.shadows; }, params)) light->omit_shadows();
  return light;
}

}  // namespace pelage
