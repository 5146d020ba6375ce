// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "geom/strands.h"

namespace pelage {

/// Repairs made while a strand file was read.
struct StrandRepairs {
  /// Number of strands that were dropped: without extent, with too few points, or with non-finite points.
  int64_t dropped = 0;
  /// Number of strands in which repeated points were removed or an unusable width was replaced.
  int64_t repaired = 0;

  StrandRepairs& operator+=(const StrandRepairs& other) {
    dropped += other.dropped;
    repaired += other.repaired;
    return *this;
  }
};

struct StrandFile {
  Strands strands;
  StrandRepairs repairs;
  std::string format;  ///< "hair", "tfx", "usd" or "alembic"
  /// Width in scene units that was chosen because neither the file nor the options state one; else 0.
  float assumed_width = 0;
  /// One line per kind of thing in the file that was not read.
  std::vector<std::string> warnings;
};

struct StrandReadOptions {
  /// Basis of the points, for file formats that do not state one; empty: pinned B-spline.
  std::optional<CurveBasis> basis;
  std::optional<float> default_width;  ///< diameter in scene units, for files without widths
  /// Also read which points of a .tfx file simulations may move, as the attribute "movable": 0 for fixed
  /// points.
  bool movable = false;
  /// Max memory in bytes that read_strands() may use, or that opening a file of USD or Alembic may use.
  int64_t max_bytes = std::numeric_limits<int64_t>::max();
};

/// The extensions of the strand formats, for messages.
inline constexpr const char* kStrandEndings = ".hair, .tfx, .usda or .abc";

/// Returns whether the file name has the extension of a supported strand format: .hair, .tfx, .abc, or .usda
/// and the other extensions of USD.
bool is_strand_file(const std::filesystem::path& path);

/// Reads strands in the format that the ending of the name selects: .hair (Cem Yuksel), .tfx (TressFX 4), USD
/// (read_usd_curves()) or Alembic (read_alembic_curves()). The id of a strand is its index in the file.
/// Repairs or drops degenerate strands, and counts them. Reads "color" and "transparency" of .hair files,
/// "opacity" and "uv" of .tfx files, and all attributes of numbers of .usda and .abc files.
///
/// Throws Error: kInput with the reason when the file is damaged, is not of this format, or is shorter than
/// the sizes in its header require; kMemory, before the strands are read, if they need more than `max_bytes`.
/// Uses less memory than 1.5 times the memory of the strands, except for USD and Alembic.
StrandFile read_strands(const std::filesystem::path& path, const StrandReadOptions& options = {});
/// Does the same to strands in the memory of the host, or to a file.
StrandFile read_strands(const AssetPath& asset, const StrandReadOptions& options = {});

/// Writes strands in the format that the extension of the file name selects. Writes the whole file or
/// nothing. Writes motion key 0 and the attributes that read_strands() reads, but neither basis nor ids.
/// Opacity becomes transparency in .hair files, and the reverse in .tfx files. A .tfx file has one width per
/// strand: the max width of the strand. Without `widths`, the file has none. Throws Error (kFailed) when the
/// file cannot be written, or when the format cannot represent the strands, such as strands with different
/// numbers of points in .tfx. A .usda file also has basis, ids, roots, motion keys at the times 0, 1 and so
/// on, and all attributes. A .abc file has ids, texture coordinates of roots and all attributes
/// (geom/io/alembic_strands.h).
void write_strands(const std::filesystem::path& path, const Strands& strands, bool widths = true);

/// Lists what a file of the format that the name selects cannot hold of these strands, for messages: "widths
/// that vary along strands (each strand gets its largest), the attribute uv". Empty if it can hold
/// everything, except for the roots of grown strands on their skin and motion keys. Throws like
/// write_strands() for unknown formats.
std::string what_is_lost(const std::filesystem::path& path, const Strands& strands);

}  // namespace pelage
