// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/strands.h"
#include "rib/syntax/rib_writer.h"

namespace pelage {

/// A parameter of Curves with its inline declaration, such as "uniform color Cs". One of the lists is empty.
struct RibParameter {
  std::string declaration;
  std::vector<float> numbers;
  std::vector<int32_t> integers;
};

/// The arguments of one call of RiCurves for a batch of strands at one motion key.
///
/// RI has no pinned B-splines. A strand of n points with phantom points (CurveBasis) therefore gets them
/// explicitly, 2 P[0] - P[1] and 2 P[n-1] - P[n-2], and has n + 2 vertices. Its widths are "varying": one per
/// joint of segments, which are as many as the points. Renderers interpolate varying widths linearly. The
/// value at a joint is the width of the point that belongs to it. Pelage's spline of widths differs from this
/// by at most a sixth of the second difference of the widths. A reader that finds exact phantom points can
/// restore the strand, bit for bit.
///
/// Parameters: "P"; "width"; "uniform integer id", the lower 32 bits of the ids, as signed numbers; "uniform
/// integer id_high", the upper 32 bits, only if any is not 0; "uniform float[2] st", texture coordinates of
/// the roots; "Cs", the attribute "color"; "point Pref", the attribute kRestPositions; and all other
/// attributes by their names.
struct RibCurves {
  const char* type = "cubic";
  const char* basis = "b-spline";  ///< null for linear curves; the step of both others is 1
  std::vector<int32_t> vertices;   ///< one per strand
  std::vector<RibParameter> parameters;
};

/// Fills `curves`, and reuses its memory. Strands in Bezier form are a bug of the caller: no groom grows any.
void make_rib_curves(const Strands& strands, int key, RibCurves& curves);

/// Writes a batch of strands: Basis, Curves and, for several motion keys, a motion block. `times`: one per
/// motion key; not used for a single key.
void write_curves(RibWriter& rib, const Strands& strands, std::span<const float> times);

}  // namespace pelage
