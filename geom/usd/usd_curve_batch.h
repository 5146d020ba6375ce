// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/vector.h"
#include "geom/strands.h"
#include "geom/usd/usd_curve_form.h"
#include "geom/usd/usd_primvar.h"

namespace pelage {

/// The curves of one BasisCurves prim. All counts fit each other.
struct UsdCurveBatch {
  UsdCurveForm form;
  M44f to_world;
  std::vector<uint32_t> counts;  ///< vertices of each curve
  std::vector<float> points;     ///< x, y, z of each vertex
  UsdPrimvar widths;             ///< radii in world space; without values: none
  UsdPrimvar root_uv;            ///< without values: none
  std::vector<uint64_t> ids;     ///< one per curve, or empty
  std::vector<std::pair<std::string, UsdPrimvar>> attributes;
};

/// Joins batches to one: curves with different bases become Catmull-Rom curves with points at sixths of their
/// segments, curves with too few vertices get none. An attribute that only some batches have is 0 in the
/// others. If all curves have different ids, sorts them by their ids. Ids of the result are indices. Frees
/// each batch after its use. `charge`: called with the max memory in bytes that joining needs beside the
/// batches, before it is taken; may throw.
StrandArrays join_usd_curves(std::vector<UsdCurveBatch> batches,
                             const std::function<void(int64_t bytes)>& charge = {});

/// Returns the memory of the attributes of all joined curves, of which each batch may have others.
int64_t joined_attribute_bytes(const std::vector<UsdCurveBatch>& batches);

}  // namespace pelage
