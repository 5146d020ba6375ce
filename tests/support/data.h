// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace pelage {

/// The folder of real meshes, grooms and images from third parties (PELAGE_DATA), or an empty path.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("PELAGE_DATA");
  return folder ? std::filesystem::path(folder) : std::filesystem::path();
}

}  // namespace pelage

/// First line of a test that reads real input. Skips the test, with a message, when the data is missing.
#define PELAGE_REQUIRE_DATA() \
  if (::pelage::data_folder().empty()) GTEST_SKIP() << "PELAGE_DATA is not set: real input is absent"
