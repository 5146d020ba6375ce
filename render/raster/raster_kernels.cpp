// SPDX-License-Identifier: Apache-2.0
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
constexpr hn::Rebind<int32_t, Floats> kIndices;
using Indices = hn::Vec<hn::Rebind<int32_t, Floats>>;

#include "render/raster/raster_lanes.inl"
//
#include "render/raster/raster_piece.inl"
//
#include "render/raster/raster_triangle.inl"

/// Collects the lines that a piece may meet, because runs contain many others, and draws to them side by
/// side.
template <class Kernel>
HWY_INLINE bool draw_piece_with(const RasterTarget& target, std::span<const TileLines::Run> runs,
                                const RasterPiece& piece, const KeySpan& keys) {
  const Kernel kernel(target, piece, keys);
  const size_t lanes = hn::Lanes(kFloats);
  bool changed = false;
  uint32_t lines[3 * TileLines::kPadding] = {};
  size_t count = 0;
  for (const TileLines::Run& run : runs) {
    for (size_t i = run.begin; i < run.end; i += lanes) {
      const M hits = kernel.may_meet(i, hn::FirstN(kFloats, run.end - i));
      if (hn::AllFalse(kFloats, hits)) continue;
      const auto numbers = hn::Iota(kWords, static_cast<uint32_t>(i));
      count += hn::CompressStore(numbers, hn::RebindMask(kWords, hits), kWords, lines + count);
      if (count < lanes) continue;
      changed |= kernel.draw(lines, lanes);
      count -= lanes;
      hn::StoreU(hn::LoadU(kWords, lines + lanes), kWords, lines);
    }
  }
  return count > 0 && kernel.draw(lines, count) ? true : changed;
}

bool draw_piece(const RasterTarget& target, std::span<const TileLines::Run> runs, const RasterPiece& piece,
                const KeySpan& keys) {
  if (piece.moves) return draw_piece_with<PieceKernel<true, true>>(target, runs, piece, keys);
  if (target.has_lens) return draw_piece_with<PieceKernel<true, false>>(target, runs, piece, keys);
  return draw_piece_with<PieceKernel<false, false>>(target, runs, piece, keys);
}

template <class Kernel>
HWY_INLINE bool draw_triangle_with(const RasterTarget& target, std::span<const TileLines::Run> runs,
                                   const RasterTriangle& triangle, const KeySpan& keys) {
  const Kernel kernel(target, triangle, keys);
  bool changed = false;
  for (const TileLines::Run& run : runs) {
    for (size_t i = run.begin; i < run.end; i += hn::Lanes(kFloats)) {
      changed |= kernel.draw(i, hn::FirstN(kFloats, run.end - i));
    }
  }
  return changed;
}

bool draw_triangle(const RasterTarget& target, std::span<const TileLines::Run> runs,
                   const RasterTriangle& triangle, const KeySpan& keys) {
  if (triangle.moves) return draw_triangle_with<TriangleKernel<true, true>>(target, runs, triangle, keys);
  if (target.has_lens) return draw_triangle_with<TriangleKernel<true, false>>(target, runs, triangle, keys);
  return draw_triangle_with<TriangleKernel<false, false>>(target, runs, triangle, keys);
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
