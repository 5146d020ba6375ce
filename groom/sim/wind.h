// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/keyed.h"
#include "base/schema.h"
#include "base/vector.h"

namespace pelage {

/// `wind:` of `dynamics:`. SI units.
struct WindParams {
  Keyed<V3f> velocity{V3f(0)};  ///< m / s
  Keyed<float> gusts{0.0f};     ///< relative strength
  float gust_seconds = 1;
  Keyed<float> turbulence{0.0f};  ///< m / s
  float eddy_size = 0.1f;         ///< m
  int64_t seed = 0;
  static const Schema<WindParams>& schema();
};

/// The velocity of the air of a scene. Gusts travel with the wind. Turbulence is the curl of smooth noise, so
/// it has no divergence [Bridson07]. A function of place and time alone. Thread safety: may be called from
/// any thread. `params` must outlive the object.
class Wind {
 public:
  /// The wind at a frame. `seconds`: time of this frame.
  Wind(const WindParams& params, double frame, double seconds);
  bool is_still() const { return is_still_; }
  /// The cell of the noise that was used last, for one thread. It makes neighbouring places cheap.
  struct Cell {
    struct Corners {
      uint64_t seed = 0;
      std::array<int64_t, 3> place{};
      bool is_known = false;
      std::array<V3d, 8> potentials;
    } older, newer;
  };
  /// Velocity in m / s at a place in metres. `cell`: of any earlier call; it does not change the result.
  V3d at(const V3d& place, Cell& cell) const;
  V3d at(const V3d& place) const {
    Cell cell;
    return at(place, cell);
  }

 private:
  const WindParams& params_;
  V3d mean_;
  double seconds_, gusts_, turbulence_;
  bool is_still_;
};

}  // namespace pelage
