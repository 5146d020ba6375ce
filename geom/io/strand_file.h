// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "geom/strands.h"

namespace pelage {

/// What was mended while a strand file was read.
struct StrandRepairs {
  int64_t dropped = 0;   ///< strands without extent, with too few points or with points that are not finite
  int64_t repaired = 0;  ///< strands that lost repeated points or got a usable width

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
  float assumed_width = 0;  ///< what strands got as a width because neither file nor options said; else 0
};

struct StrandReadOptions {
  std::optional<CurveBasis>
      basis;  ///< what the file's points are; formats that do not say default to pinned B-spline
  std::optional<float> default_width;  ///< diameter for files without widths, scene units
};

/// Whether the ending of a name is one that strands are read from and written to.
bool is_strand_file(const std::filesystem::path& path);

/// Reads strands by the format of the name's ending: Cem Yuksel's .hair, TressFX 4's .tfx. Ids are the
/// strands' places in the file. Degenerate strands are repaired or dropped and counted. Throws Error (kInput)
/// with a reason for files that are damaged, are not what they say, or claim more than they hold; memory
/// stays below 1.5 times that of the strands. Attributes: "color", "transparency" (.hair), "opacity" and "uv"
/// (.tfx).
StrandFile read_strands(const std::filesystem::path& path, const StrandReadOptions& options = {});

/// Writes strands by the format of the name's ending, whole or not at all. Motion key 0 only, neither basis
/// nor ids, and the attributes that read_strands gives. A .tfx file has one width a strand: the largest along
/// it. Throws Error (kFailed), also for what the format cannot hold: strands of unequally many points in
/// .tfx.
void write_strands(const std::filesystem::path& path, const Strands& strands);

}  // namespace pelage
