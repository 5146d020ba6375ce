// SPDX-License-Identifier: Apache-2.0
#include "lab/report/picture_svg.h"

#include "lab/report/png.h"
#include "lab/report/svg.h"

namespace pelage {

std::string picture_svg(const Picture& picture) {
  Svg svg(picture.width, picture.height, picture.caption);
  svg.image(0, 0, picture.width, picture.height, png_bytes(picture));
  for (const Label& label : picture.labels) svg.label(label);
  return std::move(svg).finish();
}

}  // namespace pelage
