// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/value_readers.h"
#include "groom/sim/rod.h"
#include "groom/sim/wind.h"

namespace pelage {

/// `dynamics:` of a groom. SI units.
struct DynamicsParams {
  std::optional<int> guides;
  int neighbours = 4;
  NameReference after;
  float density = 1300;         ///< kg / m^3
  float youngs_modulus = 4e9f;  ///< Pa
  std::optional<float> diameter;
  float damping = 0.004f;  ///< s
  float drag = 1e-4f;      ///< Pa s
  float friction = 0.3f;
  bool collide = true;
  V3f gravity{0, -9.81f, 0};
  WindParams wind;
  int substeps = 4;
  int start = 1;
  int preroll = 8;
  AssetPath directory{"cache", {}};
  static const Schema<DynamicsParams>& schema();

  RodMaterial material(double radius) const {
    return {.density = density,
            .youngs_modulus = youngs_modulus,
            .radius = radius,
            .damping = damping,
            .drag = drag,
            .friction = friction};
  }
};

}  // namespace pelage
