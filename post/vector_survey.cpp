// SPDX-License-Identifier: Apache-2.0
#include "post/vector_survey.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pelage {
namespace {

constexpr float kFramesPerSecond = 24;

}  // namespace

void VectorSurvey::add(float u, float v, Flow pixels) {
  ++count_;
  const float length = std::hypot(pixels.x, pixels.y);
  if (!std::isfinite(u) || !std::isfinite(v)) {
    ++not_finite_;
    return;
  }
  // A finite word that becomes infinite by conversion counts as the longest vector.
  longest_ = std::max(longest_, length);
  moving_ += length > 0;
  too_long_ += length > limit_;
  at_half_ += std::abs(u - 0.5f) < 0.01f && std::abs(v - 0.5f) < 0.01f;
  is_unit_ &= u >= 0 && u <= 1 && v >= 0 && v <= 1;
}

std::string VectorSurvey::long_vector_warning(const VectorParams& params, const std::string& flag) const {
  if (2 * too_long_ <= moving_) {
    return fmt::format(
        "{} of {} vectors are longer than {:.0f} pixels, the size of the picture; they look damaged",
        too_long_, moving_, static_cast<double>(limit_));
  }
  const std::string found = fmt::format("most vectors are longer than {:.0f} pixels (the longest: {:.4g}): ",
                                        static_cast<double>(limit_), static_cast<double>(longest_));
  if (params.is_ndc) return found + "they look like pixels; omit " + flag + "-units ndc";
  if (longest_ <= std::abs(params.scale) * limit_) return found + "check " + flag + "-scale";
  if (longest_ <= kFramesPerSecond * limit_) {
    return found +
           fmt::format("they look like pixels per second; at {:.0f} frames per second use {}-scale {:.4f}",
                       static_cast<double>(kFramesPerSecond), flag,
                       static_cast<double>(params.scale / kFramesPerSecond));
  }
  return found + "they look like positions or another quantity; check " + flag + "-layer";
}

std::optional<std::string> VectorSurvey::warning(const VectorParams& params, const std::string& flag,
                                                 int width, bool is_ours) const {
  if (too_long_ > 0) return long_vector_warning(params, flag);
  if (is_ours || moving_ == 0) return {};
  if (is_unit_ && 2 * at_half_ > count_) {
    return "the vectors look encoded with 0.5 for no motion; subtract 0.5 from them first";
  }
  const bool are_as_written = !params.is_ndc && params.scale == 1;
  if (are_as_written && longest_ < 1 && longest_ * static_cast<float>(width) >= 1) {
    return fmt::format(
        "no vector is longer than 1 pixel (the longest: {:.2g}); if they are normalised to the picture's "
        "size, use {}-units ndc",
        static_cast<double>(longest_), flag);
  }
  return {};
}

}  // namespace pelage
