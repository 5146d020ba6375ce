// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace pelage {

enum class TextAnchor { kStart, kMiddle, kEnd };

/// Words over a picture. Lengths are pixels, y down.
struct Label {
  double x = 0, y = 0;  ///< of the anchor, on the base line
  std::string text;
  TextAnchor anchor = TextAnchor::kStart;
  std::array<unsigned char, 3> color = {0, 0, 0};  ///< sRGB
  double size = 14;                                ///< of the font
};

}  // namespace pelage
