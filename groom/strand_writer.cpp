// SPDX-License-Identifier: Apache-2.0
#include "groom/strand_writer.h"

namespace pelage {

StrandWriter::StrandWriter(size_t strands, size_t motion_keys, std::optional<AttributeClass> colors,
                           bool has_roots)
    : keys_(motion_keys), colors_(colors), has_roots_(has_roots) {
  arrays_.motion_keys = static_cast<int>(motion_keys);
  arrays_.first_point.reserve(strands + 1);
  arrays_.first_point.push_back(0);
  arrays_.ids.resize(strands);
  if (has_roots) {
    arrays_.roots.resize(strands);
    arrays_.root_uv.resize(strands);
  }
}

void StrandWriter::expect(int points) {
  arrays_.first_point.push_back(arrays_.first_point.back() + static_cast<uint32_t>(points));
}

void StrandWriter::expect_all(int points) {
  while (arrays_.first_point.size() <= arrays_.ids.size()) expect(points);
}

size_t StrandWriter::color_rows(int points) const {
  if (!colors_) return 0;
  return *colors_ == AttributeClass::kPerPoint ? static_cast<size_t>(points) : 1;
}

void StrandWriter::write(const StrandBatch& batch, size_t first, size_t key, float length) {
  const size_t total = arrays_.first_point.back();
  if (arrays_.points.empty()) arrays_.points.resize(keys_ * total * 4);
  const size_t stride = batch.points.size() * 4;
  for (size_t p = 0; p < batch.points.size(); ++p) {
    const StrandBatch::PointRows& rows = batch.points[p];
    float* __restrict out = &arrays_.points[(key * total + arrays_.first_point[first] + p) * 4];
    for (size_t s = 0; s < batch.count; ++s, out += stride) {
      out[0] = batch.here.position[0][s] + rows.offset[0][s] * length;
      out[1] = batch.here.position[1][s] + rows.offset[1][s] * length;
      out[2] = batch.here.position[2][s] + rows.offset[2][s] * length;
      out[3] = rows.radius[s];
    }
  }
  if (key == 0 && colors_) write_colors(batch, first);
}

void StrandWriter::write_colors(const StrandBatch& batch, size_t first) {
  if (arrays_.attributes.empty()) {
    StrandAttribute color{"color", *colors_, 3, {}};
    const size_t values = *colors_ == AttributeClass::kConstant    ? 1
                          : *colors_ == AttributeClass::kPerStrand ? arrays_.ids.size()
                                                                   : arrays_.first_point.back();
    color.values.resize(3 * values);
    arrays_.attributes.push_back(std::move(color));
  }
  std::vector<float>& values = arrays_.attributes.front().values;
  const size_t rows = batch.colors.size();
  const size_t start = *colors_ == AttributeClass::kPerPoint ? arrays_.first_point[first] : first;
  const size_t count = *colors_ == AttributeClass::kConstant ? 1 : batch.count;
  for (size_t p = 0; p < rows; ++p) {
    const VectorRow& color = batch.colors[p];
    for (size_t s = 0; s < count; ++s) {
      float* out = &values[*colors_ == AttributeClass::kConstant ? 0 : 3 * (start + s * rows + p)];
      out[0] = color[0][s];
      out[1] = color[1][s];
      out[2] = color[2][s];
    }
  }
}

void StrandWriter::write_root(const StrandBatch& batch, size_t first, size_t strand,
                              const RootAddress& root) {
  arrays_.ids[first + strand] = batch.ids[strand];
  if (!has_roots_) return;
  arrays_.roots[first + strand] = root;
  arrays_.root_uv[first + strand] = V2f(batch.u[strand], batch.v[strand]);
}

StrandArrays StrandWriter::take() { return std::move(arrays_); }

}  // namespace pelage
