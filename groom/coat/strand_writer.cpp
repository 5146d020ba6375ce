// SPDX-License-Identifier: Apache-2.0
#include "groom/coat/strand_writer.h"

#include <algorithm>

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

StrandWriter::StrandWriter(Chosen chosen, size_t motion_keys, std::optional<AttributeClass> colors,
                           bool has_roots)
    : StrandWriter(chosen.strands.size(), motion_keys, colors, has_roots) {
  chosen_ = std::move(chosen);
}

size_t StrandWriter::needed(size_t first, size_t count) const {
  if (!chosen_) return count;
  const auto& strands = chosen_->strands;
  const auto end = std::lower_bound(strands.begin(), strands.end(), first + count);
  if (end == strands.begin() || *(end - 1) < first) return 0;
  return *(end - 1) - first + 1;
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

/// Calls `use` with each strand of the batch that is written, its index in the arrays, and the factors on its
/// width and colour.
template <class Use>
void StrandWriter::each(const StrandBatch& batch, size_t first, const Use& use) const {
  if (!chosen_) {
    for (size_t s = 0; s < batch.count; ++s) use(s, first + s, 1.0f, 1.0f);
    return;
  }
  const auto& strands = chosen_->strands;
  for (auto at = std::lower_bound(strands.begin(), strands.end(), first);
       at != strands.end() && *at < first + batch.count; ++at) {
    const auto i = static_cast<size_t>(at - strands.begin());
    use(*at - first, i, chosen_->width[i], chosen_->color.empty() ? 1.0f : chosen_->color[i]);
  }
}

void StrandWriter::write(const StrandBatch& batch, size_t first, size_t key, float length) {
  const size_t total = arrays_.first_point.back();
  if (arrays_.points.empty()) arrays_.points.resize(keys_ * total * 4);
  for (size_t p = 0; p < batch.points.size(); ++p) {
    const StrandBatch::PointRows& rows = batch.points[p];
    float* to = &arrays_.points[(key * total + p) * 4];
    each(batch, first, [&](size_t s, size_t strand, float width, float) {
      float* __restrict out = to + size_t(arrays_.first_point[strand]) * 4;
      out[0] = batch.current.position[0][s] + rows.offset[0][s] * length;
      out[1] = batch.current.position[1][s] + rows.offset[1][s] * length;
      out[2] = batch.current.position[2][s] + rows.offset[2][s] * length;
      out[3] = rows.radius[s] * width;
    });
  }
  if (key == 0 && colors_) write_colors(batch, first);
}

void StrandWriter::write_colors(const StrandBatch& batch, size_t first) {
  if (arrays_.attributes.empty()) {
    StrandAttribute color{"color", *colors_, 3, {}};
    const size_t values = *colors_ == AttributeClass::kConstant    ? std::min<size_t>(1, arrays_.ids.size())
                          : *colors_ == AttributeClass::kPerStrand ? arrays_.ids.size()
                                                                   : arrays_.first_point.back();
    color.values.resize(3 * values);
    arrays_.attributes.push_back(std::move(color));
  }
  std::vector<float>& values = arrays_.attributes.front().values;
  for (size_t p = 0; p < batch.colors.size(); ++p) {
    const VectorRow& color = batch.colors[p];
    each(batch, first, [&](size_t s, size_t strand, float, float factor) {
      const size_t at = *colors_ == AttributeClass::kConstant    ? 0
                        : *colors_ == AttributeClass::kPerStrand ? strand
                                                                 : arrays_.first_point[strand] + p;
      for (size_t c = 0; c < 3; ++c) values[3 * at + c] = color[c][s] * factor;
    });
  }
}

void StrandWriter::write_roots(const StrandBatch& batch, size_t first, const FollicleTree& follicles,
                               size_t begin) {
  each(batch, first, [&](size_t s, size_t strand, float, float) {
    arrays_.ids[strand] = batch.ids[s];
    if (!has_roots_) return;
    arrays_.roots[strand] = follicles.root(begin + s);
    arrays_.root_uv[strand] = V2f(batch.u[s], batch.v[s]);
  });
}

StrandArrays StrandWriter::take() { return std::move(arrays_); }

}  // namespace pelage
