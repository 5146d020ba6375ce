// SPDX-License-Identifier: Apache-2.0
#include "render/raster/segment_cell_view.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

V3f random_point(uint64_t i) {
  return {signed_float(hash64(i, 0)), signed_float(hash64(i, 1)), signed_float(hash64(i, 2))};
}

TEST(SegmentCellView, BoxesContainTheCornersOfSegmentCellBounds) {
  std::vector<Box3f> boxes;  // 30 boxes at two keys
  for (uint64_t i = 0; i < 60; ++i) {
    const V3f centre =
        V3f(5, -3, 8) + random_point(i / 2) + static_cast<float>(i % 2) * V3f(0.2f, -0.3f, 0.1f);
    const V3f half(0.02f * (1.5f + unit_float(hash64(i, 3))));
    boxes.emplace_back(centre - half, centre + half);
  }
  const SegmentCellBounds cell_bounds(boxes, 2);
  const float margin = 0.01f;
  const TileFrame frame = TileFrame::along(V3f(1, 2, 3), V3f(0.6f, 0, 0.8f));
  const SegmentCellView view(frame, cell_bounds.grid(), margin);
  size_t checked = 0;
  for (size_t g = 0; g < cell_bounds.level(0).size(); ++g) {
    const FourViewBoxes seen = view(cell_bounds.level(0)[g]);
    for (size_t lane = 0; lane < 4; ++lane) {
      const size_t b = 4 * g + lane;
      ASSERT_EQ(SegmentCellView::exists(cell_bounds.level(0)[g], lane), b < cell_bounds.count());
      if (b >= cell_bounds.count()) continue;
      for (const float time : {0.0f, 0.5f, 1.0f}) {
        const Box3f box = cell_bounds.box(b, time);
        for (int corner = 0; corner < 8; ++corner) {
          const V3f at = frame.local({corner & 1 ? box.max.x + margin : box.min.x - margin,
                                      corner & 2 ? box.max.y + margin : box.min.y - margin,
                                      corner & 4 ? box.max.z + margin : box.min.z - margin});
          EXPECT_TRUE(seen.low.x[lane] <= at.x && at.x <= seen.high.x[lane]);
          EXPECT_TRUE(seen.low.y[lane] <= at.y && at.y <= seen.high.y[lane]);
          EXPECT_TRUE(seen.low.z[lane] <= at.z && at.z <= seen.high.z[lane]);
          ++checked;
        }
      }
      EXPECT_LT(seen.high.z[lane] - seen.low.z[lane], 1.5f);
    }
  }
  EXPECT_EQ(checked, 30u * 24);
}

}  // namespace
}  // namespace pelage
