// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "geom/strands.h"

namespace pelage {

/// Repairs made while a strand file was read.
struct StrandRepairs {
  int64_t dropped = 0;   ///< strands without extent, with too few points, or with non-finite points
  int64_t repaired = 0;  ///< strands with repeated points removed or an unusable width replaced

  StrandRepairs& operator+=(const StrandRepairs& other) {
    dropped += other.dropped;
    repaired += other.repaired;
    return *this;
  }
};

struct StrandFile {
  Strands strands;
  StrandRepairs repairs;
  std::string format;       ///< "hair" or "tfx"
  float assumed_width = 0;  ///< width given to strands because neither file nor options state one; else 0
};

struct StrandReadOptions {
  std::optional<CurveBasis>
      basis;  ///< basis of the file's points; default for formats that do not state one: pinned B-spline
  std::optional<float> default_width;  ///< diameter for files without widths, scene units
};

/// Whether the file name has the extension of a supported strand format (.hair or .tfx).
bool is_strand_file(const std::filesystem::path& path);

/// Reads strands. The file name's extension selects the format: Cem Yuksel's .hair, TressFX 4's .tfx. Ids are
/// the strands' indices in the file. Degenerate strands are repaired or dropped, and counted. Throws Error
/// (kInput) with a reason for files that are damaged, of another format, or too short for the sizes that they
/// claim; memory stays below 1.5 times the memory of the strands. Attributes: "color", "transparency"
/// (.hair), "opacity" and "uv" (.tfx).
StrandFile read_strands(const std::filesystem::path& path, const StrandReadOptions& options = {});

/// Writes strands in the format of the file name's extension, completely or not at all: motion key 0 and the
/// attributes that read_strands returns, without basis and ids. A .tfx file has one width per strand: the max
/// along it. Throws Error (kFailed), also for strands that the format cannot represent: different numbers of
/// points in .tfx.
void write_strands(const std::filesystem::path& path, const Strands& strands);

}  // namespace pelage
