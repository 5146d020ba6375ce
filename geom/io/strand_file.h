// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "geom/strands.h"

namespace pelage {

/// What was mended while a strand file was read.
struct StrandRepairs {
  int64_t dropped = 0;   ///< strands with fewer than 2 distinct points or with points that are not finite
  int64_t repaired = 0;  ///< strands that lost coincident points or got a usable width
};

struct StrandFile {
  Strands strands;
  StrandRepairs repairs;
  std::string format;  ///< "hair" or "tfx"
};

struct StrandReadOptions {
  std::optional<CurveBasis>
      basis;  ///< what the file's points are; formats that do not say default to pinned B-spline
  std::optional<float> default_width;  ///< diameter for files without widths, scene units
};

/// Reads strands by the format of the name's ending: Cem Yuksel's .hair, TressFX .tfx. Degenerate strands are
/// repaired or dropped and counted. Throws Error (kInput) with a reason for files that are damaged, are not
/// what they say, or claim more than they hold.
StrandFile read_strands(const std::filesystem::path& path, const StrandReadOptions& options = {});

/// Writes strands by the format of the name's ending, whole or not at all. Motion key 0 only. Throws Error
/// (kFailed), also for what the format cannot hold.
void write_strands(const std::filesystem::path& path, const Strands& strands);

}  // namespace pelage
