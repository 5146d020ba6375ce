// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace pelage {

enum class TextAnchor { kStart, kMiddle, kEnd };

/// Text over a picture. Lengths in pixels, y down.
struct Label {
  double x = 0, y = 0;  ///< of the anchor, on the baseline
  std::string text;
  TextAnchor anchor = TextAnchor::kStart;
  std::array<unsigned char, 3> color = {0, 0, 0};  ///< sRGB
  double size = 14;                                ///< of the font
};

}  // namespace pelage
