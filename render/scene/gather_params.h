// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "base/value_readers.h"

namespace pelage {

/// How the gather integrator finds what the camera sees.
enum class GatherVisibility { kRays, kRaster };
template <>
struct EnumNames<GatherVisibility> {
  static constexpr const char* names[] = {"rays", "raster"};
};

/// `gather:` of `render:`.
struct GatherParams {
  GatherVisibility visibility = GatherVisibility::kRays;
  bool reuse = true;
  float spacing = 4;       ///< max distance of knots along strands, pixels
  float skin_spacing = 2;  ///< max distance of knots on skins, pixels
  float light_rays = 3;    ///< max shadow rays per visible sample
  float paths = 1;         ///< indirect paths per visible sample, before roulette
  static const Schema<GatherParams>& schema();
};

}  // namespace pelage
