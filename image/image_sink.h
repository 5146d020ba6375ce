// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "image/texel_layout.h"

namespace pelage {

/// Header of an image file.
struct ImageHeader {
  TexelLayout layout;
  bool is_integer = false;    ///< whether the file stores integers
  int64_t working_bytes = 0;  ///< estimated temporary memory of reading the file
};

/// Receives an image: first its header, then strips of `count` whole rows from the top. Either function may
/// throw an exception, which ends the reading.
class ImageSink {
 public:
  virtual ~ImageSink() = default;
  virtual void begin(const ImageHeader& header) = 0;
  virtual void rows(const std::byte* rows, int count) = 0;
};

}  // namespace pelage
