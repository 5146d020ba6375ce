// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <variant>

#include "base/keyed.h"
#include "base/ledger.h"
#include "base/value_readers.h"
#include "render/light/light.h"

namespace pelage {

class TextureLibrary;

struct RectangleLightParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "rectangle";
  Keyed<V3f> position{V3f(0)};        ///< centre
  Keyed<V3f> look_at{V3f(0, 0, -1)};  ///< the emitting side faces this point
  V3f up{0, 1, 0};
  V2f size{1, 1};  ///< width, height
  Rgb radiance{1};
  Keyed<float> intensity{1.0f};  ///< factor of the radiance
  bool two_sided = false;
  bool visible = false;  ///< whether the camera sees the light
  static const Schema<RectangleLightParams>& schema();
};
struct SphereLightParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "sphere";
  Keyed<V3f> position{V3f(0)};
  float radius = 1;
  Rgb radiance{1};
  Keyed<float> intensity{1.0f};
  bool visible = false;
  static const Schema<SphereLightParams>& schema();
};
struct EnvironmentLightParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "environment";
  AssetPath file;   ///< lat-long image, see EnvironmentMap; empty: constant radiance
  Rgb radiance{1};  ///< factor of the image, or the constant radiance
  Keyed<float> intensity{1.0f};
  V3f rotate{0};  ///< rotation about x, then y, then z, in degrees
  bool visible = true;
  static const Schema<EnvironmentLightParams>& schema();
};
using LightParams = std::variant<RectangleLightParams, SphereLightParams, EnvironmentLightParams>;

/// Makes a light with its parameters at `frame`. `origin`: RenderScene::origin. Throws Error (kInput) for
/// missing images.
std::unique_ptr<Light> make_light(const std::string& name, const LightParams& params, double frame,
                                  TextureLibrary& textures, MemoryLedger& ledger, const V3f& origin = V3f(0));

}  // namespace pelage
