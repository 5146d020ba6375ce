// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/alembic/alembic_curves_writer.h"

namespace pelage {

/// Returns the facts of a file: its group is the name of the file without its ending.
AlembicCurvesFacts alembic_facts(const std::filesystem::path& path, bool widths,
                                 AlembicHost host = AlembicHost::kAny);

/// Writes strands, at motion key 0, as an Alembic file (.abc): a transform "groom" (alembic_groom()) with the
/// curves "hair" (add_alembic_curves()). Throws Error (kFailed) when the file cannot be written.
void write_alembic_strands(const std::filesystem::path& path, const Strands& strands,
                           const AlembicCurvesFacts& facts);

}  // namespace pelage
