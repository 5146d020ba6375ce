// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/exr.h"
#include "lab/report/report.h"

namespace pelage {

/// The mean of some pictures minus the mean of others, times `factor`, pixel by pixel: grey where both are
/// equal. A byte is 255 (0.5 + factor * difference), clipped. Empty when a list is empty, or when sizes
/// differ or R, G or B is missing.
std::optional<Picture> scaled_difference(const std::vector<ExrImage>& pictures,
                                         const std::vector<ExrImage>& references, double factor,
                                         const std::string& caption);

/// The same for files; also empty when one of them cannot be read.
std::optional<Picture> scaled_difference_of_files(const std::vector<std::filesystem::path>& pictures,
                                                  const std::vector<std::filesystem::path>& references,
                                                  double factor, const std::string& caption);

}  // namespace pelage
