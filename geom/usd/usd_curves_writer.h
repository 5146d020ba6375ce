// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geom/strands.h"
#include "geom/usd/usd_writer.h"

namespace pelage {

/// What a prim of curves states besides its strands.
struct UsdCurvesFacts {
  bool widths = true;  ///< whether the strands have widths
  std::string coat;    ///< primvar groom:coat, such as "rat.under"; empty: none
  std::string role;    ///< primvar groom:role: guard, under or whisker; empty: none
  /// primvar groom:priority, one per strand: strands with smaller numbers are kept longer when detail is
  /// reduced; empty: none.
  std::vector<float> priority;
};

/// Strands at one or more times. `times`: one per motion key, in frames; empty: the strands do not move.
struct UsdCurvesSample {
  Strands strands;
  std::vector<double> times;
};

/// Writes a BasisCurves prim. `sample(i)` returns sample i of `count`, and is called once or twice for each.
/// All samples have the strands of the first one, at other positions. Strands that do not move have one
/// sample without times. kPinnedBSpline is written as bspline with wrap "pinned", kBSpline with wrap
/// "nonperiodic". Widths are "vertex" values, as the radius of our points is: they follow the basis. The
/// attributes "color" and "opacity" become displayColor and displayOpacity, all others primvars of their
/// names. Per-point attributes are "varying", as they are linear between points (kBSpline: "vertex"). Root
/// texture coordinates become the uniform primvar st, ids the uniform primvar ids, root addresses the
/// primvars groom:face and groom:faceUv. Returns the extent of all samples together.
Box3f write_usd_curves(UsdWriter& usd, const std::string& name, const UsdCurvesFacts& facts, size_t count,
                       const std::function<UsdCurvesSample(size_t)>& sample);

/// Returns the box that USD calls the extent: a box around the control points and the curves, enlarged by
/// half the largest width.
Box3f usd_extent(const Strands& strands, int key);

}  // namespace pelage
