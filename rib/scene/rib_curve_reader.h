// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/strands.h"
#include "rib/syntax/rib_basis.h"
#include "rib/syntax/rib_parameters.h"

namespace pelage {

/// The strands of one request Curves, in the space of the request. Without a parameter "id", the strands have
/// the numbers 0, 1, ... as ids.
struct RibCurveSet {
  StrandArrays strands;
  bool has_ids = false;
  bool has_color = false;                ///< attribute "color", from Cs
  bool has_opacity = false;              ///< attribute "opacity", the mean of the channels of Os
  bool has_width = false;                ///< otherwise the width is 1
  bool negative_widths = false;          ///< some radii are negative
  bool ribbons = false;                  ///< the curves have normals ("N"), which have no effect
  size_t unusable = 0;                   ///< curves whose points do not form whole segments; no strands
  std::vector<std::string> misfits;      ///< what is wrong with parameters that have a wrong count of values
  std::vector<std::string> undeclared;   ///< parameters without a type, which are ignored
  std::vector<std::string> unsupported;  ///< parameters of other kinds that are ignored, such as strings
};

/// Converts a request Curves. `samples`: the same request at each time of a motion block, or a single one.
/// Only "P" and "width" of the further samples are read. Throws Error (kInput) for wrong types, and for wrong
/// counts of "P", widths and ids. A parameter whose count fits another class has this class.
///
/// Linear curves and cubic B-splines of step 1 are taken as they are. Curves whose first and last points are
/// exactly the phantom points of CurveBasis (as Pelage writes them) lose these two points and get
/// the basis kPinnedBSpline or kCatmullRom; this restores the strand, bit for bit. All other curves become a
/// B-spline with four segments per segment, which interpolates the curve and its end tangents. Where two
/// segments do not meet, a new strand begins. Curves with the wrap mode "pinned" are those with phantom
/// points, which this mode implies.
///
/// Widths and other values per joint of segments ("varying") or per point ("vertex") become values per point.
RibCurveSet read_curves(std::span<RibStatement> samples, const RibDeclarations& declarations,
                        const RibBasis& basis);

}  // namespace pelage
