// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/vector.h"

namespace pelage {

// Maps in UDIM tiles: the file of the tile that covers u .. u + 1 and v .. v + 1 (whole numbers, u below 10)
// has the number 1001 + u + 10 v.

inline constexpr int kFirstTile = 1001, kLastTile = 1999;

/// Whether a path has a placeholder for the number of the tile: <UDIM> or %(UDIM)d.
bool has_tiles(const std::filesystem::path& path);
/// Returns the file of a tile.
std::filesystem::path udim_file(const std::filesystem::path& path, int tile);
/// Returns the number of the tile at texture coordinates; 0 where there can be none.
int tile_at(float u, float v);
/// Returns the path itself or, for a path with a placeholder, the files of all tiles that exist.
std::vector<std::filesystem::path> map_files(const std::filesystem::path& path);

}  // namespace pelage
