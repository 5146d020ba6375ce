// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/interchange/geometry_file.h"

namespace pelage {

/// Reads all curves of an Alembic file (.abc, Ogawa) as one batch, in world space. The file states neither
/// unit nor up axis, so both stay. Reads all types and wraps, and the bases B-spline, Bezier and Catmull-Rom;
/// curves without a basis become linear. Reads widths, texture coordinates of the roots, and parameters of
/// numbers of every scope (.arbGeomParams). Names of Unreal's grooms: groom_id, groom_root_uv, groom_width if
/// there are no other widths, and groom_color, which becomes "color". Curves with groom_guide are skipped if
/// the file has others. Curves of files that Pelage wrote get back their points (write_alembic_curves()). Of
/// several time samples, reads the earliest. Bases, ids and sorting are as in read_usd_curves().
///
/// Throws Error: kInput with the object or the position in bytes for malformed files and counts that do not
/// fit, kMemory when the strands need more than `max_bytes`.
CurvesFile read_alembic_curves(const std::filesystem::path& path, const CurvesReadOptions& options = {});

/// Scalar in .userProperties of curves that Pelage writes: 1 if the first and last vertex of each curve are
/// the phantom vertices of a curve that begins at its second vertex.
inline constexpr const char* kAlembicPhantomEnds = "pelage_phantom_ends";

}  // namespace pelage
