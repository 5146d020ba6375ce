// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_window.h"

#include <cmath>

#include "base/check.h"
#include "render/film/film_sums.h"

namespace pelage {

FrameWindow frame_window(int width, int height, const std::optional<PixelBox>& region,
                         std::optional<PixelFilter> splat) {
  FrameWindow window;
  window.picture = {0, 0, width, height};
  window.region = region.value_or(window.picture);
  const PixelBox& r = window.region;
  PELAGE_CHECK(!r.is_empty() && intersection(r, window.picture) == r);
  const int apron = splat ? static_cast<int>(std::ceil(filter_radius(*splat) - 0.5f)) : 0;
  window.traced = intersection({r.x0 - apron, r.y0 - apron, r.x1 + apron, r.y1 + apron}, window.picture);
  // Film tiles at the same places as in the whole picture add their samples in the same order.
  constexpr int kSide = FilmSums::kTileSide;
  const auto up = [](int pixel) { return (pixel + kSide - 1) / kSide * kSide; };
  const PixelBox& t = window.traced;
  window.film =
      intersection({t.x0 / kSide * kSide, t.y0 / kSide * kSide, up(t.x1), up(t.y1)}, window.picture);
  return window;
}

}  // namespace pelage
