// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// The program that a file is made for.
enum class AlembicHost {
  kAny,
  /// Unreal Engine's importer of grooms: x, y and z become x, z and y, since its z points up and its axes are
  /// left-handed; strands are linear, through points on the curves, since it draws them so; and widths and
  /// colours are also parameters groom_width and groom_color of each vertex.
  kUnreal
};

}  // namespace pelage
