// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "post/flow_field.h"

namespace pelage {

/// Interpretation of a file's vectors.
struct VectorParams {
  bool is_ndc = false;   ///< fractions of the display window instead of pixels
  bool is_y_up = false;  ///< positive v points up, as in Nuke; Pelage writes it pointing down
  float scale = 1;       ///< additional factor that converts the vectors to motion per frame
};

/// Statistics of a layer of vectors, collected while it is read, to recognise a wrong unit.
class VectorSurvey {
 public:
  /// `limit`: length in pixels above which a vector counts as too long.
  explicit VectorSurvey(float limit) : limit_(limit) {}

  /// Adds one pixel: the words of the file, and the resulting vector in pixels.
  void add(float u, float v, Flow pixels);

  size_t not_finite() const { return not_finite_; }
  /// A warning if the vectors probably have another unit than the parameters declare; it names the option to
  /// change. Empty otherwise. `flag`: prefix of the options' names, "--motion". `width`: of the display
  /// window. `is_ours`: the file comes from Pelage, whose vectors are always in pixels.
  std::optional<std::string> warning(const VectorParams& params, const std::string& flag, int width,
                                     bool is_ours) const;

 private:
  std::string long_vector_warning(const VectorParams& params, const std::string& flag) const;

  float limit_;
  float longest_ = 0;  // in pixels, over all finite vectors
  size_t count_ = 0, not_finite_ = 0;
  size_t moving_ = 0;    // non-zero
  size_t too_long_ = 0;  // among moving_
  size_t at_half_ = 0;   // both words within 0.01 of 0.5
  bool is_unit_ = true;  // all words lie within 0 and 1
};

}  // namespace pelage
