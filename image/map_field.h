// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/value_readers.h"
#include "image/field_nodes.h"
#include "image/texture_library.h"

namespace pelage {

enum class MapChannel { kR, kG, kB, kA };
template <>
struct EnumNames<MapChannel> {
  static constexpr const char* names[] = {"r", "g", "b", "a"};
};

/// What a map is outside its image: its border, the image again, or the stored value 0.
enum class MapWrap { kClamp, kRepeat, kBlack };
template <>
struct EnumNames<MapWrap> {
  static constexpr const char* names[] = {"clamp", "repeat", "black"};
};

enum class MapProjection { kTexture, kPlanar, kTriplanar, kCylinder, kSphere, kFace };
template <>
struct EnumNames<MapProjection> {
  static constexpr const char* names[] = {"texture", "planar", "triplanar", "cylinder", "sphere", "face"};
};

enum class MapAxis { kX, kY, kZ };
template <>
struct EnumNames<MapAxis> {
  static constexpr const char* names[] = {"x", "y", "z"};
};

/// Keys of {map: f.png, channel: r, range: [a, b], space: auto, wrap: clamp, projection: texture}. Stored
/// values 0 and 1 become a and b.
struct MapForm {
  AssetPath map;
  std::optional<MapChannel> channel;
  V2f range{0, 1};
  ColorSpace space = ColorSpace::kAuto;
  MapWrap wrap = MapWrap::kClamp;
  MapProjection projection = MapProjection::kTexture;
  std::optional<MapAxis> axis;  ///< empty: z for planar, y for cylinder and sphere
  std::optional<V3f> center;    ///< rest space; empty: the middle of the skin's bounds
  std::optional<V3f> size;      ///< empty: the size of the skin's bounds
  static const Schema<MapForm>& schema();
};

Field map_field(MapForm form);

}  // namespace pelage
