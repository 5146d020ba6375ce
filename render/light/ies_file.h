// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace pelage {

/// Luminous intensity of a luminaire by direction, as a photometric file (IES) states it: type C photometry.
struct IesPhotometry {
  /// Angles to the axis of the lamp, in degrees: at least two, ascending, from 0 to 180.
  std::vector<float> vertical;
  /// Angles about the axis, in degrees, ascending. One angle alone: the lamp is the same all around. From 0
  /// to 90: symmetric about both planes; from 0 to 180: about the plane of 0 and 180; from 90 to 270: about
  /// the plane of 90 and 270; from 0 to 360: not symmetric.
  std::vector<float> horizontal;
  /// Candela, not below 0, at least one above: for each horizontal angle, all vertical angles. Includes the
  /// factors of the file.
  std::vector<float> candela;
};

/// Reads a photometric file of the formats LM-63-1986, 1991, 1995 and 2002 (IES) [Iesna02]. A missing last
/// angle of 360 degrees is added. The effect of tilting a lamp (TILT) is ignored: it applies to lamps that
/// are not mounted as usual.
///
/// Throws Error (kInput) with the line of the first mistake: numbers that are malformed, not finite or
/// missing, angles in wrong order or of an unknown symmetry, candela below 0, no light at all. Also throws it
/// for the photometric types A and B.
IesPhotometry read_ies(const std::filesystem::path& path);

}  // namespace pelage
