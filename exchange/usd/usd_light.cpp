// SPDX-License-Identifier: Apache-2.0
#include "exchange/usd/usd_shading.h"
#include "exchange/usd/usd_skin.h"

namespace pelage {
namespace {

using Kind = ExportedLight::Kind;

void write_transform(UsdWriter& usd, const M44f& m) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    text +=
        fmt::format("{}({}, {}, {}, {})", row == 0 ? "" : ", ", m[row][0], m[row][1], m[row][2], m[row][3]);
  }
  usd.line(fmt::format("matrix4d xformOp:transform = ( {} )", text));
  usd.line("uniform token[] xformOpOrder = [\"xformOp:transform\"]");
}

const char* light_type(Kind kind) {
  switch (kind) {
    case Kind::kRectangle:
      return "RectLight";
    case Kind::kDisk:
      return "DiskLight";
    case Kind::kSphere:
    case Kind::kSpot:
      return "SphereLight";
    case Kind::kSun:
      return "DistantLight";
    case Kind::kEnvironment:
    case Kind::kMesh:
      break;
  }
  return "DomeLight";
}

/// The radiance: the largest component is the intensity, and the rest the colour.
void write_radiance(UsdWriter& usd, const ExportedLight& light) {
  const float intensity = max_component(light.radiance);
  const Rgb color = intensity > 0 ? light.radiance / intensity : Rgb(1);
  usd.line(fmt::format("float inputs:intensity = {}", intensity));
  usd.line(fmt::format("color3f inputs:color = ({}, {}, {})", color.x, color.y, color.z));
  if (!light.shadows) usd.line("bool inputs:shadow:enable = 0");
}

void write_shape(UsdWriter& usd, const ExportedLight& light, ExportNotes& notes) {
  const std::string subject = "light '" + light.name + "'";
  if (light.kind == Kind::kRectangle) {
    usd.line(fmt::format("float inputs:width = {}", light.size.x));
    usd.line(fmt::format("float inputs:height = {}", light.size.y));
    if (light.two_sided) notes.add(subject, "it shines to one side only");
  }
  if (light.kind == Kind::kDisk || light.kind == Kind::kSphere || light.kind == Kind::kSpot)
    usd.line(fmt::format("float inputs:radius = {}", light.radius));
  if (light.kind == Kind::kSpot) {
    usd.line(fmt::format("float inputs:shaping:cone:angle = {}", light.angle));
    usd.line(fmt::format("float inputs:shaping:cone:softness = {}", light.softness));
    notes.add(subject, "renderers fade the border of the cone in different ways");
    if (!light.image.empty()) notes.add(subject, "its gobo is lost");
  }
  if (light.kind == Kind::kSun) usd.line(fmt::format("float inputs:angle = {}", light.angle));
  const bool has_image = light.kind == Kind::kRectangle || light.kind == Kind::kEnvironment;
  if (has_image && !light.image.empty())
    usd.line("asset inputs:texture:file = " + usd_asset(std::filesystem::absolute(light.image).string()));
  if (light.kind == Kind::kEnvironment) usd.line("token inputs:texture:format = \"latlong\"");
}

/// The centre column of our images is along -z, that of USD's along +z.
M44f dome_to_world(const ExportedLight& light) {
  const M44f turn(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
  return turn * light.rotation;
}

}  // namespace

void write_usd_light(UsdWriter& usd, const std::string& name, const ExportedLight& light,
                     ExportNotes& notes) {
  if (light.kind == Kind::kMesh) {
    const UsdMeshSample sample{0, light.mesh.positions};
    open_usd_mesh(usd, name, R"("MeshLightAPI", "ShadowAPI")", light.mesh, SubdivisionScheme::kNone,
                  BoundaryRule::kEdgeAndCorner, {&sample, 1});
    write_radiance(usd, light);
    usd.close();
    return;
  }
  const char* schemas = light.kind == Kind::kSpot ? R"("ShapingAPI", "ShadowAPI")" : R"("ShadowAPI")";
  usd.open(fmt::format("def {} {} (prepend apiSchemas = [{}])", light_type(light.kind), usd_string(name),
                       schemas));
  write_radiance(usd, light);
  write_shape(usd, light, notes);
  if (light.kind == Kind::kSphere || light.kind == Kind::kSpot) {
    if (light.visible) notes.add("light '" + light.name + "'", "UsdLux has no visibility to the camera");
  }
  write_transform(usd, light.kind == Kind::kEnvironment ? dome_to_world(light) : light_to_world(light));
  usd.close();
}

}  // namespace pelage
