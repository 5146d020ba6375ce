// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/interchange/geometry_file.h"
#include "geom/usd/usd_source.h"

namespace pelage {

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
CurvesFile read_usd_curves(const UsdSource& source, const CurvesReadOptions& options = {});

}  // namespace pelage
