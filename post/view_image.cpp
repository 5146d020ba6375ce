// SPDX-License-Identifier: Apache-2.0
#include "post/view_image.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "post/soft_edges.h"

namespace pelage {
namespace {

/// Number of rows read at once when a whole channel is needed.
constexpr int kRows = 64;

PixelBox enclosing(const PixelBox& a, const PixelBox& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

ViewImage::ViewImage(ExrReader& reader, const std::vector<NamedChannel>& channels, const std::string& view,
                     const LayerChoice& choice)
    : reader_(reader), channels_(channels), layers_(channels, reader.parts(), view, choice) {
  for (size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].view != view) continue;
    const ExrPart& part = reader.parts()[channels[i].part];
    canvas_ = own_.empty() ? part.data : enclosing(canvas_, part.data);
    limits_ = own_.empty() ? part.display : enclosing(limits_, part.display);
    own_.push_back(i);
  }
  limits_ = enclosing(limits_, canvas_);
  const int64_t width = int64_t{canvas_.x1} - canvas_.x0, height = int64_t{canvas_.y1} - canvas_.y0;
  const int64_t max = FlowField::kLargestSide;
  if (width > max || height > max) {
    throw Error(ErrorKind::kInput, {reader.path().string(), 0, 0},
                fmt::format("its pixels span {} x {}; the limit is {} per side", width, height, max));
  }
}

int ViewImage::largest_reach() const {
  const auto diagonal = [](const PixelBox& box) {
    return std::hypot(double{1} * box.x1 - box.x0, double{1} * box.y1 - box.y0);
  };
  return static_cast<int>(
      std::ceil(std::min(diagonal(limits_), std::max(diagonal(canvas_), double{kUsualReach}))));
}

void ViewImage::read_into(const std::vector<size_t>& wanted, int first, int last, float* words) const {
  const auto width = static_cast<size_t>(canvas_.width());
  const size_t plane = width * static_cast<size_t>(last - first);
  for (size_t p = 0; p < reader_.parts().size(); ++p) {
    const PixelBox& data = reader_.parts()[p].data;
    const int y0 = std::max(first + canvas_.y0, data.y0), y1 = std::min(last + canvas_.y0, data.y1);
    if (y0 >= y1) continue;
    const int x0 = std::max(data.x0, canvas_.x0), x1 = std::min(data.x1, canvas_.x1);
    if (x0 >= x1) continue;
    // A part without a view may be wider than this view's canvas: then it needs separate rows.
    const bool is_inside = x0 == data.x0 && x1 == data.x1;
    const auto own_width = static_cast<size_t>(data.width());
    const auto row_count = static_cast<size_t>(y1 - y0),
               first_row = static_cast<size_t>(y0 - canvas_.y0 - first);
    std::vector<ExrRows> rows;
    std::vector<float*> targets;
    for (size_t i = 0; i < wanted.size(); ++i) {
      const NamedChannel& channel = channels_[wanted[i]];
      if (channel.part != p) continue;
      targets.push_back(words + i * plane + first_row * width + static_cast<size_t>(x0 - canvas_.x0));
      rows.push_back({channel.channel, targets.back(), width});
    }
    std::vector<float> wide(is_inside ? 0 : rows.size() * own_width * row_count);
    for (size_t i = 0; i < rows.size() && !is_inside; ++i) {
      rows[i].words = wide.data() + i * own_width * row_count;
      rows[i].row_stride = own_width;
    }
    reader_.read(p, y0, y1, rows);
    for (size_t i = 0; i < rows.size() && !is_inside; ++i) {
      for (size_t y = 0; y < row_count; ++y) {
        const float* from = rows[i].words + y * own_width + static_cast<size_t>(x0 - data.x0);
        std::copy(from, from + (x1 - x0), targets[i] + y * width);
      }
    }
  }
}

void ViewImage::read(const std::vector<size_t>& wanted, int first, int last,
                     std::vector<float>& words) const {
  words.assign(wanted.size() * static_cast<size_t>(canvas_.width()) * static_cast<size_t>(last - first), 0);
  read_into(wanted, first, last, words.data());
}

std::vector<float> ViewImage::read_depth(std::optional<size_t> depth, std::optional<size_t> alpha,
                                         std::vector<uint8_t>& edges) const {
  std::vector<size_t> wanted;
  if (depth) wanted.push_back(*depth);
  if (alpha) wanted.push_back(*alpha);
  std::vector<float> result;
  result.reserve(static_cast<size_t>(canvas_.width()) * static_cast<size_t>(canvas_.height()));
  edges.clear();
  edges.reserve(result.capacity());
  std::vector<float> words;
  for (int y = 0; y < canvas_.height(); y += kRows) {
    const int rows = std::min(kRows, canvas_.height() - y);
    const size_t count = static_cast<size_t>(rows) * static_cast<size_t>(canvas_.width());
    read(wanted, y, y + rows, words);
    const float* z = depth ? words.data() : nullptr;
    const float* a = alpha ? words.data() + (depth ? count : 0) : nullptr;
    for (size_t i = 0; i < count; ++i) {
      const bool is_clear = a && a[i] == 0;  // empty, whatever its depth
      result.push_back(is_clear ? std::numeric_limits<float>::infinity() : z ? z[i] : 1);
      edges.push_back(a ? edge_bits(a[i], result.back()) : uint8_t{0});
    }
  }
  return result;
}

std::vector<Flow> ViewImage::read_vectors(std::pair<size_t, size_t> uv, const VectorParams& params,
                                          VectorSurvey& survey) const {
  const PixelBox& display = reader_.parts()[channels_[uv.first].part].display;
  float sx = params.scale, sy = params.is_y_up ? -params.scale : params.scale;
  if (params.is_ndc) {
    sx *= static_cast<float>(display.width());
    sy *= static_cast<float>(display.height());
  }
  std::vector<Flow> result;
  result.reserve(static_cast<size_t>(canvas_.width()) * static_cast<size_t>(canvas_.height()));
  std::vector<float> words;
  for (int y = 0; y < canvas_.height(); y += kRows) {
    const int rows = std::min(kRows, canvas_.height() - y);
    const size_t count = static_cast<size_t>(rows) * static_cast<size_t>(canvas_.width());
    read({uv.first, uv.second}, y, y + rows, words);
    for (size_t i = 0; i < count; ++i) {
      const Flow m{sx * words[i], sy * words[count + i]};
      survey.add(words[i], words[count + i], m);
      // A finite word in a wrong unit must not become infinite, which would count as no motion.
      result.push_back(std::isfinite(words[i]) && std::isfinite(words[count + i]) ? FlowField::cut(m) : m);
    }
  }
  return result;
}

}  // namespace pelage
