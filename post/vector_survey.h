// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "post/flow_field.h"

namespace pelage {

/// Unit and direction of the vectors in a file.
struct VectorParams {
  bool is_ndc = false;   ///< true: fractions of the display window's size; false: pixels
  bool is_y_up = false;  ///< true: positive v points up, as in Nuke; false: down, as in files of Pelage
  float scale = 1;       ///< factor that converts the vectors to motion per frame
};

/// Collects statistics of the vectors of a layer while they are read, to recognise that VectorParams are
/// wrong.
class VectorSurvey {
 public:
  /// `limit`: length in pixels above which a vector counts as too long.
  explicit VectorSurvey(float limit) : limit_(limit) {}

  /// Adds the vector of one pixel: u and v as stored in the file, and the converted vector in pixels.
  void add(float u, float v, Flow pixels);

  /// Count of vectors with a non-finite u or v.
  size_t not_finite() const { return not_finite_; }
  /// Returns a warning if the vectors are damaged or probably have another unit than `params` declares; else
  /// an empty value. The warning names the command line option to change. `flag`: prefix of these options,
  /// such as "--motion". `width`: width of the display window in pixels. `is_ours`: whether Pelage wrote the
  /// file; its vectors are always in pixels.
  std::optional<std::string> warning(const VectorParams& params, const std::string& flag, int width,
                                     bool is_ours) const;

 private:
  std::string long_vector_warning(const VectorParams& params, const std::string& flag) const;

  float limit_;
  float longest_ = 0;  // max length of all finite vectors, in pixels
  size_t count_ = 0, not_finite_ = 0;
  size_t moving_ = 0;    // count of non-zero vectors
  size_t too_long_ = 0;  // count of vectors longer than limit_
  size_t at_half_ = 0;   // count of vectors with u and v within 0.01 of 0.5
  bool is_unit_ = true;  // all u and v are in [0, 1]
};

}  // namespace pelage
