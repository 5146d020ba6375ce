// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace pelage {

enum class TextAnchor { kStart, kMiddle, kEnd };

/// Text on top of a picture. Lengths are in pixels; y points down.
struct Label {
  double x = 0, y = 0;  ///< position of the anchor, on the baseline
  std::string text;
  TextAnchor anchor = TextAnchor::kStart;
  std::array<unsigned char, 3> color = {0, 0, 0};  ///< sRGB
  double size = 14;                                ///< size of the font
};

}  // namespace pelage
