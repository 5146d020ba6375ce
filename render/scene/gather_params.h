// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/schema.h"
#include "base/value_readers.h"

namespace pelage {

/// How the gather integrator finds the strands and skins that the camera sees.
enum class GatherVisibility { kRays, kRaster };
template <>
struct EnumNames<GatherVisibility> {
  static constexpr const char* names[] = {"rays", "raster"};
};

/// `gather:` of `render:`.
struct GatherParams {
  std::optional<GatherVisibility> visibility;  ///< empty: see RenderParams::draws_visible()
  bool reuse = true;                           ///< false: samples share no light
  float spacing = 4;                           ///< max distance between gather points along a strand, pixels
  float skin_spacing = 2;                      ///< max distance between gather points on a skin, pixels
  bool cells = true;                           ///< whether neighbouring thin strands share light
  float min_width = 0;                         ///< width at which the camera sees thinner strands, pixels
  float light_rays = 3;                        ///< mean count of shadow rays per visible sample
  bool reject = false;  ///< whether directions from which no first ray arrived get no rays; biased
  float paths = 1;      ///< mean count of indirect paths per visible sample, before roulette
  /// Whether indirect paths end in the reflection cache; empty: see RenderParams::uses_cache().
  std::optional<bool> cache;
  float cache_paths = 0.25f;  ///< paths that fill the cache / camera samples
  ByteSize memory{};          ///< max memory of the cache; 0: what `render.memory` leaves

  static const Schema<GatherParams>& schema();
};

}  // namespace pelage
