// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/strands.h"

namespace pelage {

/// The strands of a USD file.
struct UsdCurvesFile {
  StrandArrays strands;  ///< one motion key; ids are indices; no roots
  bool has_widths = false;
  std::vector<std::string> warnings;  ///< one per kind of thing that was skipped
};

struct UsdCurvesOptions {
  /// Max memory for the strands, in bytes. Without another limit, what no machine of today has.
  int64_t max_bytes = int64_t(1) << 42;
};

/// Reads all BasisCurves prims of a USD file (.usda) as one batch, in world space with y up: the file states
/// its up axis. Lengths stay in the unit of the file. Reads all types, bases and wraps. Prims that are all
/// linear, pinned or nonperiodic B-splines, or pinned Catmull-Rom curves keep their points; others, and files
/// that mix them, become Catmull-Rom curves with points at sixths of the segments. Reads widths, st of the
/// roots, and primvars of numbers of every interpolation; displayColor and displayOpacity become "color" and
/// "opacity". If all strands have different ids (primvars:ids or ids), the strands are sorted by them, so
/// that strands of a coat keep their order and, if none is missing, their ids. Of attributes with time
/// samples, reads the earliest. Composes the scene as read_usd_mesh() does.
///
/// Throws Error: kInput with line and column for malformed files and counts that do not fit, kMemory when the
/// strands need more than `max_bytes`.
UsdCurvesFile read_usd_curves(const std::filesystem::path& path, const UsdCurvesOptions& options = {});
/// Does the same with a text. `path`: for messages.
UsdCurvesFile read_usd_curves(const std::filesystem::path& path, std::string_view text,
                              const UsdCurvesOptions& options = {});

}  // namespace pelage
