// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "image/image_sink.h"

namespace pelage {

/// Stores the header and the rows of an image.
class KeptImage final : public ImageSink {
 public:
  void begin(const ImageHeader& got) override { header = got, ++begun; }
  void rows(const std::byte* rows, int count) override {
    texels.insert(texels.end(), rows, rows + size_t(count) * header.layout.row_bytes());
  }
  ImageHeader header;
  int begun = 0;
  std::vector<std::byte> texels;
};

}  // namespace pelage
