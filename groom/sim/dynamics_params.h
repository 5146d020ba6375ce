// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "groom/sim/rod.h"
#include "groom/sim/wind.h"

namespace pelage {

enum class DynamicsMode { kSimulated, kKinematic };
template <>
struct EnumNames<DynamicsMode> {
  static constexpr const char* names[] = {"simulated", "kinematic"};
};

/// `dynamics:` of a groom. SI units.
struct DynamicsParams {
  DynamicsMode mode = DynamicsMode::kSimulated;
  /// Strand files that hold the guides of each frame, with a placeholder for its number (world/frames.h);
  /// empty: the guides are computed.
  AssetPath files;
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
  std::vector<NameReference> collide_with;
  float volume = 0;  ///< Hz
  V3f gravity{0, -9.81f, 0};
  WindParams wind;
  int substeps = 4;
  float sway_frequency = 3;  ///< Hz
  float sway_damping = 0.25f;
  int start = 1;
  int preroll = 8;
  AssetPath directory{"cache", {}};
  static const Schema<DynamicsParams>& schema();

  /// Whether `pelage simulate` makes the motion.
  bool is_simulated() const { return mode == DynamicsMode::kSimulated && files.empty(); }
  /// Number of guides of a coat with so many strands. Sway follows the skin, which varies slowly across a
  /// coat, and each animal of a crowd has turns of its own, so fewer guides suffice for it.
  size_t guide_count(size_t strands) const;
  /// How many guides a coat has by default, in words.
  std::string default_guides() const;

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
