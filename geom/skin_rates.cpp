// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_rates.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace pelage {

namespace {

constexpr size_t kLinesAtOnce = 256;

/// Number of pieces of a line so that none is longer on screen than requested, in any of the poses.
uint32_t line_rate(const SkinLattice::Line& line, const SkinLattice& lattice,
                   std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options) {
  float pixels = 0;
  for (const LimitSurface& surface : keys) {
    V3f p[3];
    float scale = 0;
    for (int i = 0; i < 3; ++i) {
      const V2f uv = lattice.side_uv(line.side, 0.5f * static_cast<float>(i));
      p[i] = surface.evaluate(line.face, uv.x, uv.y).position;
      scale = std::max(scale, view.pixels_per_unit(p[i]));
    }
    pixels = std::max(pixels, ((p[1] - p[0]).length() + (p[2] - p[1]).length()) * scale);
  }
  if (line.is_half) pixels *= 2;
  const auto max = static_cast<float>(std::max(options.max_rate, line.halved ? 2 : 1));
  const float wanted = std::ceil(pixels / options.edge_pixels);
  auto rate = static_cast<uint32_t>(wanted < max ? std::max(wanted, 1.0f) : max);
  if (line.halved && rate % 2 != 0) rate += static_cast<float>(rate + 1) <= max ? 1 : -1;
  return rate;
}

}  // namespace

void set_rates(SkinLattice& lattice, std::span<const LimitSurface> keys, const View& view,
               const TessellationOptions& options, const Workers& workers,
               const std::function<void()>& check_stop) {
  PELAGE_CHECK(!keys.empty());
  for (const LimitSurface& key : keys) PELAGE_CHECK(&key.topology() == &keys[0].topology());
  const size_t end = std::min(options.end_rated_key, keys.size());
  PELAGE_CHECK(options.first_rated_key < end);
  // Flat triangles need no division, however near they are.
  if (keys[0].topology().impl().flat) return;
  const auto rated = keys.subspan(options.first_rated_key, end - options.first_rated_key);
  std::vector<SkinLattice::Line>& lines = lattice.lines();
  workers.for_each(lines.size(), kLinesAtOnce, [&](WorkRange range) {
    check_stop();
    for (size_t i = range.begin; i < range.end; ++i)
      lines[i].rate = line_rate(lines[i], lattice, rated, view, options);
  });
}

}  // namespace pelage
