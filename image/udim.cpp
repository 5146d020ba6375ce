// SPDX-License-Identifier: Apache-2.0
#include "image/udim.h"

#include <cmath>
#include <string>

namespace pelage {
namespace {

constexpr std::string_view kPlaceholders[] = {"<UDIM>", "%(UDIM)d"};

}  // namespace

bool has_tiles(const std::filesystem::path& path) {
  const std::string text = path.string();
  for (const std::string_view placeholder : kPlaceholders) {
    if (text.find(placeholder) != std::string::npos) return true;
  }
  return false;
}

std::filesystem::path udim_file(const std::filesystem::path& path, int tile) {
  std::string text = path.string();
  for (const std::string_view placeholder : kPlaceholders) {
    if (const size_t at = text.find(placeholder); at != std::string::npos)
      text.replace(at, placeholder.size(), std::to_string(tile));
  }
  return text;
}

int tile_at(float u, float v) {
  const float column = std::floor(u), row = std::floor(v);
  if (!(column >= 0 && column < 10 && row >= 0 && row < 100)) return 0;
  const int tile = kFirstTile + static_cast<int>(column) + 10 * static_cast<int>(row);
  return tile <= kLastTile ? tile : 0;
}

std::vector<std::filesystem::path> map_files(const std::filesystem::path& path) {
  if (!has_tiles(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (int tile = kFirstTile; tile <= kLastTile; ++tile) {
    std::error_code ignored;
    std::filesystem::path file = udim_file(path, tile);
    if (std::filesystem::exists(file, ignored)) files.push_back(std::move(file));
  }
  return files;
}

}  // namespace pelage
