// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_files.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

#include "base/file.h"
#include "geom/usd/usd_layer.h"

namespace pelage {
namespace {

void add_assets(const std::vector<UsdArc>& arcs, std::vector<std::string>& assets) {
  for (const UsdArc& arc : arcs) {
    if (!arc.asset.empty()) assets.push_back(arc.asset);
  }
}

void add_assets(const UsdPrimSpec& spec, std::vector<std::string>& assets) {
  add_assets(spec.references, assets);
  add_assets(spec.payloads, assets);
  for (const UsdPrimSpec& child : spec.children) add_assets(child, assets);
  for (const auto& [set, variants] : spec.variant_sets) {
    for (const UsdPrimSpec& variant : variants) add_assets(variant, assets);
  }
}

/// Whether a file has the character that begins the name of an asset. Reads a part at a time.
bool has_asset(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> part(1 << 16);
  while (file) {
    file.read(part.data(), static_cast<std::streamsize>(part.size()));
    const auto end = part.begin() + static_cast<ptrdiff_t>(file.gcount());
    if (std::find(part.begin(), end, '@') != end) return true;
  }
  return false;
}

std::vector<std::string> assets_of(const std::filesystem::path& path) {
  std::vector<std::string> assets;
  try {
    // Most large files name no other, which is found faster than they are parsed.
    if (!has_asset(path)) return assets;
    const UsdLayer layer(path);
    add_assets(layer.sublayers(), assets);
    add_assets(layer.root(), assets);
  } catch (const Error&) {
    assets.clear();
  }
  return assets;
}

}  // namespace

bool is_usd_file(const std::filesystem::path& path) {
  const std::string ending = lower_extension(path);
  return ending == ".usda" || ending == ".usd" || ending == ".usdc" || ending == ".usdz";
}

std::vector<std::filesystem::path> usd_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files{path};
  std::set<std::filesystem::path> known{path.lexically_normal()};
  for (size_t i = 0; i < files.size(); ++i) {
    const std::filesystem::path folder = files[i].parent_path();
    for (const std::string& asset : assets_of(files[i])) {
      const std::filesystem::path named = (folder / asset).lexically_normal();
      if (known.insert(named).second && file_problem(named).empty()) files.push_back(named);
    }
  }
  return files;
}

std::vector<std::filesystem::path> with_usd_files(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> all;
  for (const std::filesystem::path& file : files) {
    const std::vector<std::filesystem::path> found =
        is_usd_file(file) ? usd_files(file) : std::vector<std::filesystem::path>{file};
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace pelage
