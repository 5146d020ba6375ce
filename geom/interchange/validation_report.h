// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pelage {

/// The result of checking a strand file: what other programs may stumble over.
struct ValidationReport {
  size_t curves = 0, strands = 0, points = 0;  ///< counts of curves objects, and of their strands and points
  size_t meshes = 0;
  std::vector<std::string> problems;  ///< one line each, with place: wrong data
  std::vector<std::string> remarks;   ///< one line each, with place: data that programs may need
};

}  // namespace pelage
