// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/schema.h"
#include "base/value_readers.h"
#include "procedurals/chunk_bounds.h"

namespace pelage {

enum class Integrator { kPath };
template <>
struct EnumNames<Integrator> {
  static constexpr const char* names[] = {"path"};
};
enum class AccelKind { kEmbree };
template <>
struct EnumNames<AccelKind> {
  static constexpr const char* names[] = {"embree"};
};
enum class CurveShape { kFlat, kRound };
template <>
struct EnumNames<CurveShape> {
  static constexpr const char* names[] = {"flat", "round"};
};

/// `render:` of a scene.
struct RenderParams {
  Integrator integrator = Integrator::kPath;
  AccelKind accel = AccelKind::kEmbree;
  CurveShape curves = CurveShape::kFlat;
  int samples = 64;
  int bounces = 4;  ///< 0 = direct light only
  int64_t seed = 0;
  ByteSize memory{uint64_t(4) << 30};
  BoundingStrategy bounds = BoundingStrategy::kExact;
  float bounds_factor = 1;  ///< of BoundingStrategy::kUser
  static const Schema<RenderParams>& schema();
};

}  // namespace pelage
