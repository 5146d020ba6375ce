// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/vector.h"
#include "geom/interchange/curve_form.h"
#include "geom/interchange/geometry_file.h"
#include "geom/interchange/primvar.h"
#include "geom/interchange/read_budget.h"
#include "geom/interchange/read_warnings.h"

namespace pelage {

/// The curves of one object of a file. All counts fit each other.
struct CurveBatch {
  CurveForm form;
  M44f to_world;
  std::vector<uint32_t> counts;  ///< vertices of each curve
  std::vector<float> points;     ///< x, y, z of each vertex
  Primvar widths;                ///< radii in world space; without values: none
  Primvar root_uv;               ///< without values: none
  std::vector<uint64_t> ids;     ///< one per curve, or empty
  std::vector<std::pair<std::string, Primvar>> attributes;

  /// Sets `widths` from the widths that the file states, in the space of the object.
  void set_widths(Primvar stated);
  /// Heap bytes of all arrays.
  size_t bytes() const;
};

/// Joins the batches of a file to one. Curves with different bases become Catmull-Rom curves with points at
/// sixths of their segments. Curves with too few vertices get no points. An attribute that only some batches
/// have is 0 in the others. If all curves have different ids, sorts the curves by their ids. Ids of the
/// result are indices. Frees each batch after its use. Adds a warning if only some batches have widths;
/// returns all warnings with the strands.
///
/// Before joining, charges the memory to `budget` that joining needs beside the batches. Throws its error
/// with `file`, the position of the file.
CurvesFile join_curves(std::vector<CurveBatch> batches, const SourcePosition& file, ReadBudget& budget,
                       ReadWarnings& warnings);

}  // namespace pelage
