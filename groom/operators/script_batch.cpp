// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/script_batch.h"

namespace pelage {
namespace {

void add_vector(const VectorRow& row, size_t strand, std::vector<float>& to) {
  for (const StrandRow& axis : row) to.push_back(axis[strand]);
}

void add_frame(const RootRows& rows, size_t strand, std::vector<float>& to) {
  add_vector(rows.tangent, strand, to);
  add_vector(rows.bitangent, strand, to);
  add_vector(rows.normal, strand, to);
}

}  // namespace

ScriptBatch::ScriptBatch(const StrandBatch& batch, std::span<const size_t> indices)
    : strands(indices.size()),
      points(batch.points.size()),
      color_rows(batch.colors.size()),
      scale(batch.scale) {
  positions.reserve(strands * points * 3);
  widths.reserve(strands * points);
  for (const size_t s : indices) {
    ids.push_back(batch.ids[s]);
    for (const StrandBatch::PointRows& rows : batch.points) {
      add_vector(rows.offset, s, positions);
      widths.push_back(2 * rows.radius[s]);
    }
    for (const VectorRow& color : batch.colors) add_vector(color, s, colors);
    add_vector(batch.current.position, s, roots);
    add_frame(batch.current, s, frames);
    add_vector(batch.rest.position, s, rest_roots);
    add_frame(batch.rest, s, rest_frames);
    uv.push_back(batch.u[s]);
    uv.push_back(batch.v[s]);
    clump.push_back(batch.clump[s]);
  }
  new_positions = positions;
  new_widths = widths;
  new_colors = colors;
}

PelageScriptBatch ScriptBatch::view() {
  return {.strands = strands,
          .points = points,
          .color_rows = color_rows,
          .seed = 0,
          .writes_colors = 0,
          .scale = scale,
          .ids = ids.data(),
          .positions = positions.data(),
          .widths = widths.data(),
          .colors = colors.data(),
          .roots = roots.data(),
          .frames = frames.data(),
          .rest_roots = rest_roots.data(),
          .rest_frames = rest_frames.data(),
          .uv = uv.data(),
          .clump = clump.data(),
          .new_positions = new_positions.data(),
          .new_widths = new_widths.data(),
          .new_colors = new_colors.data()};
}

void ScriptBatch::write(StrandBatch& batch) const {
  const auto vector = [](const std::vector<float>& values, size_t i) {
    return V3f(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  };
  for (size_t s = 0; s < strands; ++s) {
    for (size_t p = 0; p < points; ++p) {
      set_vector(batch.points[p].offset, s, vector(new_positions, s * points + p));
      batch.points[p].radius[s] = new_widths[s * points + p] / 2;
    }
    for (size_t c = 0; c < color_rows; ++c)
      set_vector(batch.colors[c], s, vector(new_colors, s * color_rows + c));
  }
}

}  // namespace pelage
