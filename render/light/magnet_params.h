// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "base/keyed.h"
#include "base/schema.h"
#include "render/light/magnet_set.h"

namespace pelage {

struct RectangleMagnetParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "rectangle";
  Keyed<V3f> position{V3f(0)};  ///< centre
  Keyed<V3f> look_at{V3f(0, 0, -1)};
  V3f up{0, 1, 0};
  V2f size{1, 1};
  float share = 0.3f;
  static const Schema<RectangleMagnetParams>& schema();
};
struct SphereMagnetParams {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "sphere";
  Keyed<V3f> position{V3f(0)};
  float radius = 1;
  float share = 0.3f;
  static const Schema<SphereMagnetParams>& schema();
};
using MagnetParams = std::variant<RectangleMagnetParams, SphereMagnetParams>;

/// Makes a magnet with its parameters at `frame`. `origin`: RenderScene::origin. Throws Error (kInput) if a
/// rectangle looks at its own centre.
MagnetSet::Magnet make_magnet(const std::string& name, const MagnetParams& params, double frame,
                              const V3f& origin = V3f(0));

}  // namespace pelage
