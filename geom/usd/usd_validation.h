// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pelage {

/// What a host may stumble over in a USD file.
struct UsdFindings {
  size_t curves = 0, strands = 0, points = 0;  ///< BasisCurves prims, and what they have
  size_t meshes = 0;
  std::vector<std::string> problems;  ///< one line each, with place: wrong data
  std::vector<std::string> remarks;   ///< one line each, with place: data that hosts may lack
};

/// Checks the curves of a USD file: that there are any, numbers that are not finite, curves with fewer points
/// than they need, counts that do not fit or that change over time, widths that are missing or negative,
/// extents that are missing or too small at any time sample; and, as remarks, missing texture coordinates of
/// roots and ids. Throws Error (kInput) as read_usd_curves() does for malformed text.
UsdFindings validate_usd(const std::filesystem::path& path);

}  // namespace pelage
