// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/ledger.h"
#include "base/vector.h"
#include "render/light/ies_file.h"

namespace pelage {

/// Lumens per watt of radiant power that relate photometric files to watts: those of the illuminant D65
/// between 360 and 830 nm, as in Cycles.
inline constexpr double kLumensPerWatt = 177.83;

/// How brightly a lamp shines in each direction, relative to the mean over all directions. Immutable. Thread
/// safety: const members may be called from any thread.
class LightProfile {
 public:
  /// Returns the memory, in bytes, that a profile takes.
  static int64_t bytes(const IesPhotometry& ies);

  /// `charge`: for bytes().
  explicit LightProfile(IesPhotometry ies, MemoryCharge charge = {});

  /// Returns the intensity in a direction (unit) divided by the mean intensity. Intensities are interpolated
  /// linearly between angles, and are 0 beyond the vertical angles of the file. The lamp shines along z:
  /// there, the vertical angle is 0. The horizontal angle is 0 at -y and 90 degrees at -x.
  float factor(const V3f& direction) const;
  /// Returns whether no light is closer to the axis than an angle, in degrees.
  bool is_dark_within(float degrees) const;
  /// Returns the radiant power of the lamp by the file, in W, if each of its lumens has 1 / kLumensPerWatt.
  float watts() const { return watts_; }

 private:
  MemoryCharge charge_;
  IesPhotometry ies_;  // with intensities relative to their mean
  float watts_ = 0;
};

}  // namespace pelage
