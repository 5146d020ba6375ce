// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "exchange/usd/usd_shading.h"

namespace pelage {
namespace {

std::string usd_tuple(const Rgb& c) { return fmt::format("({}, {}, {})", c.x, c.y, c.z); }

void write_preview(UsdWriter& usd, const ExportedMaterial& material) {
  float roughness = 1, ior = 1.5f;
  if (const auto* glossy = std::get_if<GlossyParams>(material.params)) {
    roughness = glossy->roughness;
    ior = glossy->ior;
  }
  if (material.hair) roughness = material.hair->beta_m, ior = material.hair->eta;
  usd.open("def Shader \"preview\"");
  usd.line("uniform token info:id = \"UsdPreviewSurface\"");
  usd.line("color3f inputs:diffuseColor = " + usd_tuple(material.color));
  usd.line(fmt::format("float inputs:roughness = {}", roughness));
  usd.line(fmt::format("float inputs:ior = {}", ior));
  if (std::holds_alternative<LambertParams>(*material.params)) {
    usd.line("int inputs:useSpecularWorkflow = 1");
    usd.line("color3f inputs:specularColor = (0, 0, 0)");
  }
  usd.line("token outputs:surface");
  usd.close();
}

/// MaterialX takes the variances and scales of lobes, and the tilt as a fraction of half a turn.
void write_hair(UsdWriter& usd, const std::string& path, const HairModel& hair) {
  const float v = hair.longitudinal_variance(), s = hair.azimuthal_scale();
  usd.open("def Shader \"hair\"");
  usd.line("uniform token info:id = \"ND_chiang_hair_bsdf\"");
  usd.line(fmt::format("float inputs:ior = {}", hair.eta));
  usd.line(fmt::format("float2 inputs:roughness_R = ({}, {})", v, s));
  usd.line(fmt::format("float2 inputs:roughness_TT = ({}, {})", 0.25f * v, s));
  usd.line(fmt::format("float2 inputs:roughness_TRT = ({}, {})", 4 * v, s));
  usd.line(fmt::format("float inputs:cuticle_angle = {}", 0.5f + hair.alpha / 180));
  usd.line("float3 inputs:absorption_coefficient = " + usd_tuple(hair.absorption));
  usd.line("token outputs:out");
  usd.close();
  usd.open("def Shader \"hair_surface\"");
  usd.line("uniform token info:id = \"ND_surface\"");
  usd.line(fmt::format("token inputs:bsdf.connect = <{}/hair.outputs:out>", path));
  usd.line("token outputs:out");
  usd.close();
}

}  // namespace

void write_usd_material(UsdWriter& usd, const std::string& path, const std::string& name,
                        const ExportedMaterial& material) {
  const std::string own = path + "/" + name;
  usd.open(fmt::format("def Material {}", usd_string(name)));
  usd.line(fmt::format("token outputs:surface.connect = <{}/preview.outputs:surface>", own));
  if (material.hair)
    usd.line(fmt::format("token outputs:mtlx:surface.connect = <{}/hair_surface.outputs:out>", own));
  write_preview(usd, material);
  if (material.hair) write_hair(usd, own, *material.hair);
  usd.close();
}

}  // namespace pelage
