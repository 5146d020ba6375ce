// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "image/exr.h"

namespace pelage {

/// Returns the common pixels of two boxes; a box without pixels if they have none.
inline PixelBox common_pixels(const PixelBox& a, const PixelBox& b) {
  const PixelBox box{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return box.width() > 0 && box.height() > 0 ? box : PixelBox{};
}

/// Returns boxes that together contain each pixel of `frame` that no box of `covered` contains, once.
inline std::vector<PixelBox> uncovered_boxes(const PixelBox& frame, const std::vector<PixelBox>& covered) {
  std::vector<PixelBox> left{frame};
  for (const PixelBox& cover : covered) {
    std::vector<PixelBox> rest;
    for (const PixelBox& box : left) {
      const PixelBox cut = common_pixels(box, cover);
      if (cut.width() == 0) {
        rest.push_back(box);
        continue;
      }
      for (const PixelBox& part :
           {PixelBox{box.x0, box.y0, box.x1, cut.y0}, PixelBox{box.x0, cut.y0, cut.x0, cut.y1},
            PixelBox{cut.x1, cut.y0, box.x1, cut.y1}, PixelBox{box.x0, cut.y1, box.x1, box.y1}}) {
        if (part.width() > 0 && part.height() > 0) rest.push_back(part);
      }
    }
    left = std::move(rest);
  }
  return left;
}

}  // namespace pelage
