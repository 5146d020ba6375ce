// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/exr.h"
#include "lab/report/report.h"

namespace pelage {

/// Returns `factor` times the difference between two means, pixel by pixel: the mean of `pictures` minus the
/// mean of `references`. Shows it as bytes 255 * (0.5 + factor * difference), clipped, so that grey means no
/// difference. Empty when a list is empty, when sizes differ, or when a picture lacks R, G or B.
std::optional<Picture> scaled_difference(const std::vector<ExrImage>& pictures,
                                         const std::vector<ExrImage>& references, double factor,
                                         const std::string& caption);

/// Computes the same picture from files. Also empty when one of them cannot be read.
std::optional<Picture> scaled_difference_of_files(const std::vector<std::filesystem::path>& pictures,
                                                  const std::vector<std::filesystem::path>& references,
                                                  double factor, const std::string& caption);

}  // namespace pelage
