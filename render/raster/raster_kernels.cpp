// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/raster/tile_raster_test.cpp.
// Compiled once per instruction set. Lanes are independent, and products and sums are never fused, so that
// every instruction set gives the same bits.
#include "render/accel/highway_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/raster/raster_kernels.cpp"
#include <bit>
#include <cmath>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/raster/raster_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace pelage {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, TileLines::kPadding>;
using Words = hn::Rebind<uint32_t, Floats>;
using V = hn::Vec<Floats>;
using M = hn::Mask<Floats>;
constexpr Floats kFloats;
constexpr Words kWords;

#include "render/raster/raster_lanes.inl"
//
#include "render/raster/raster_piece.inl"
//
#include "render/raster/raster_triangle.inl"

template <class Shape, class Kernel>
HWY_INLINE bool draw_shape(const RasterTarget& target, std::span<const TileLines::Run> runs,
                           const Shape& shape, const KeySpan& keys) {
  const Kernel kernel(target, shape, keys);
  bool changed = false;
  for (const TileLines::Run& run : runs) {
    for (size_t i = run.begin; i < run.end; i += hn::Lanes(kFloats)) {
      changed |= kernel.draw(i, hn::FirstN(kFloats, run.end - i));
    }
  }
  return changed;
}

bool draw_piece(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterPiece& piece,
                const KeySpan& keys) {
  if (piece.moves) return draw_shape<RasterPiece, PieceKernel<true, true>>(target, runs, piece, keys);
  if (target.has_lens) return draw_shape<RasterPiece, PieceKernel<true, false>>(target, runs, piece, keys);
  return draw_shape<RasterPiece, PieceKernel<false, false>>(target, runs, piece, keys);
}

bool draw_triangle(const RasterTarget& target, std::span<const TileLines::Run> runs,
                   const RasterTriangle& triangle, const KeySpan& keys) {
  if (triangle.moves)
    return draw_shape<RasterTriangle, TriangleKernel<true, true>>(target, runs, triangle, keys);
  if (target.has_lens)
    return draw_shape<RasterTriangle, TriangleKernel<true, false>>(target, runs, triangle, keys);
  return draw_shape<RasterTriangle, TriangleKernel<false, false>>(target, runs, triangle, keys);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pelage
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pelage {
namespace {
HWY_EXPORT(draw_piece);
HWY_EXPORT(draw_triangle);
}  // namespace

bool draw(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterPiece& piece,
          const KeySpan& keys) {
  return HWY_DYNAMIC_DISPATCH(draw_piece)(target, runs, piece, keys);
}
bool draw(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterTriangle& triangle,
          const KeySpan& keys) {
  return HWY_DYNAMIC_DISPATCH(draw_triangle)(target, runs, triangle, keys);
}

}  // namespace pelage
#endif
