// SPDX-License-Identifier: Apache-2.0
#include "exchange/exported_light.h"

#include <numbers>

#include "exchange/still_geometry.h"
#include "geom/io/host_geometry.h"
#include "geom/io/mesh_file.h"
#include "render/light/aim.h"
#include "render/light/environment_light.h"

namespace pelage {
namespace {

using Kind = ExportedLight::Kind;

double area_of(const ControlMesh& mesh) {
  const std::vector<uint32_t> triangles = cage_triangles(mesh);
  double area = 0;
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const V3f& a = mesh.positions[triangles[i]];
    area +=
        0.5 *
        double{(mesh.positions[triangles[i + 1]] - a).cross(mesh.positions[triangles[i + 2]] - a).length()};
  }
  return area;
}

/// What limits the directions of a light and is not exported, in the plural; empty: nothing.
std::string lost_shaping(const LightParams& params) {
  std::string lost;
  const auto add = [&](std::string_view what) { lost += (lost.empty() ? "" : " and ") + std::string(what); };
  std::visit(
      [&](const auto& p) {
        if constexpr (requires { p.barn_doors; }) {
          if (p.barn_doors) add("its barn doors");
        }
        if constexpr (requires { p.spread; }) {
          if (p.spread < 180) add("the limits of its spread");
        }
        if constexpr (requires { p.profile; }) {
          if (!p.profile.empty()) add("the intensities of its profile");
        }
      },
      params);
  return lost;
}

struct ExportedLightOf {
  const std::string& name;
  double frame;
  float factor;

  ExportedLight operator()(const RectangleLightParams& p) const {
    ExportedLight light = facing(Kind::kRectangle, p, p.up);
    light.size = p.size;
    light.two_sided = p.two_sided;
    light.image = p.file.path.string();
    return light;
  }
  ExportedLight operator()(const DiskLightParams& p) const {
    ExportedLight light = facing(Kind::kDisk, p, V3f(0, 1, 0));
    light.radius = p.radius;
    return light;
  }
  ExportedLight operator()(const SphereLightParams& p) const { return sphere(p); }
  ExportedLight operator()(const PointLightParams& p) const { return sphere(p); }
  ExportedLight operator()(const SpotLightParams& p) const {
    ExportedLight light = facing(Kind::kSpot, p, p.up);
    light.radius = p.radius;
    light.angle = 0.5f * p.cone;
    light.softness = p.softness;
    light.image = p.file.path.string();
    return light;
  }
  ExportedLight operator()(const SunLightParams& p) const {
    ExportedLight light = common(Kind::kSun, p);
    set_axes(light, V3f(0), p.direction.at(frame), V3f(0, 1, 0));
    light.angle = p.angle;
    return light;
  }
  ExportedLight operator()(const MeshLightParams& p) const {
    ExportedLight light = common(Kind::kMesh, p);
    light.mesh = p.file.data ? host_mesh(p.file) : read_mesh_file(p.file.path);
    transform_cage(p.transform.matrix(), light.mesh);
    if (p.power) light.radiance *= static_cast<float>(*p.power / (std::numbers::pi * area_of(light.mesh)));
    return light;
  }
  ExportedLight operator()(const EnvironmentLightParams& p) const {
    ExportedLight light = common(Kind::kEnvironment, p);
    light.image = p.file.path.string();
    const M33f turn = rotation_xyz(p.rotate);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) light.rotation[i][j] = turn[i][j];
    }
    return light;
  }

 private:
  template <class Params>
  ExportedLight common(Kind kind, const Params& p) const {
    ExportedLight light;
    light.kind = kind;
    light.name = name;
    light.radiance = p.color() * (p.strength(frame) * radiance_without_spread(p) * factor);
    light.visible = p.visible;
    light.shadows = p.shadows;
    return light;
  }
  template <class Params>
  ExportedLight sphere(const Params& p) const {
    ExportedLight light = common(Kind::kSphere, p);
    light.position = p.position.at(frame);
    light.radius = p.radius;
    return light;
  }
  template <class Params>
  ExportedLight facing(Kind kind, const Params& p, const V3f& up) const {
    ExportedLight light = common(kind, p);
    light.position = p.position.at(frame);
    set_axes(light, light.position, p.look_at.at(frame), up);
    return light;
  }
  void set_axes(ExportedLight& light, const V3f& from, const V3f& to, const V3f& up) const {
    const std::optional<Aim> aim = Aim::at(from, to, up);
    if (!aim) throw Error(ErrorKind::kInput, "lights." + name + ": no direction at this frame");
    light.x = aim->x, light.y = aim->y, light.z = aim->z;
  }
};

}  // namespace

std::vector<ExportedLight> exported_lights(const SceneDescription& scene, double frame, float factor,
                                           ExportNotes& notes) {
  std::vector<ExportedLight> lights;
  for (const auto& [name, position, params] : scene.lights.items) {
    lights.push_back(std::visit(ExportedLightOf{name, frame, factor}, params));
    if (lights.back().kind == Kind::kEnvironment && !lights.back().visible)
      notes.add("light '" + name + "'", "the camera sees it");
    const auto& emission =
        std::visit([](const LightEmission& p) -> const LightEmission& { return p; }, params);
    if (const std::string lost = lost_shaping(params); !lost.empty())
      notes.add("light '" + name + "'", lost + " are lost: it shines in more directions");
    if (emission.illuminates || emission.shadowed_by)
      notes.add("light '" + name + "'", "it illuminates everything, and everything casts a shadow in it");
  }
  return lights;
}

M44f light_to_world(const ExportedLight& light) {
  const V3f &x = light.x, &y = light.y, &z = light.z, &p = light.position;
  return {-x.x, -x.y, -x.z, 0, y.x, y.y, y.z, 0, -z.x, -z.y, -z.z, 0, p.x, p.y, p.z, 1};
}

}  // namespace pelage
