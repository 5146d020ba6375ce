// SPDX-License-Identifier: Apache-2.0
#include "render/film/film.h"

#include <cmath>
#include <cstddef>
#include <functional>

#include "base/check.h"

namespace pelage {
namespace {

bool is_finite(const Rgb& c) { return std::isfinite(c.x + c.y + c.z); }

}  // namespace

Film::Film(int width, int height, FilmLayers layers, MemoryLedger& ledger)
    : width_(width), height_(height), layers_(std::move(layers)), stride_(4 + 3 * layers_.size()) {
  const size_t pixels = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  charge_ = MemoryCharge(ledger, MemoryTag::kFilm, bytes_needed(width, height, layers_));
  sums_.resize(pixels * stride_);
  counts_.resize(pixels);
  surfaces_.resize(pixels);
  if (layers_.noise) moments_.resize(pixels);
}

int64_t Film::bytes_needed(int width, int height, const FilmLayers& layers) {
  const size_t stride = 4 + 3 * layers.size();
  const size_t pixel =
      stride * sizeof(float) + sizeof(uint32_t) + sizeof(Surface) + (layers.noise ? sizeof(PixelMoments) : 0);
  return static_cast<int64_t>(width) * height * static_cast<int64_t>(pixel);
}

bool Film::add(int x, int y, const FilmSample& sample, std::span<const Rgb> by_layer) {
  PELAGE_CHECK(by_layer.size() == layers_.size());
  if (!is_finite(sample.radiance) || !std::isfinite(sample.alpha)) return false;
  for (const Rgb& part : by_layer) {
    if (!is_finite(part)) return false;
  }
  const size_t pixel = index(x, y);
  float* sum = &sums_[pixel * stride_];
  for (int c = 0; c < 3; ++c) sum[c] += sample.radiance[c];
  sum[3] += sample.alpha;
  sum += 4;
  for (const Rgb& part : by_layer) {
    for (int c = 0; c < 3; ++c) *sum++ += part[c];
  }
  ++counts_[pixel];
  if (!moments_.empty()) moments_[pixel].add(luminance(sample.radiance));

  Surface& kept = surfaces_[pixel];
  const bool nearer = sample.surface.depth < kept.sample.depth;
  const bool first_inside = sample.inside_pixel && !kept.inside_pixel;
  if (first_inside || (nearer && sample.inside_pixel == kept.inside_pixel)) {
    kept = {sample.surface, sample.inside_pixel};
  }
  return true;
}

float Film::average(size_t pixel, size_t channel) const {
  const uint32_t count = counts_[pixel];
  return count > 0 ? sums_[pixel * stride_ + channel] / static_cast<float>(count) : 0.0f;
}

Rgb Film::radiance(int x, int y) const {
  const size_t p = index(x, y);
  return {average(p, 0), average(p, 1), average(p, 2)};
}

float Film::alpha(int x, int y) const { return average(index(x, y), 3); }

Rgb Film::layer(int x, int y, size_t layer) const {
  const size_t p = index(x, y), c = 4 + 3 * layer;
  return {average(p, c), average(p, c + 1), average(p, c + 2)};
}

std::vector<ExrChannel> Film::exr_rows(int y0, int y1) const {
  const size_t first_pixel = index(0, y0), pixels = index(0, y1) - first_pixel;
  std::vector<ExrChannel> channels;
  const auto add_channel = [&](std::string name, ChannelType type,
                               const std::function<float(size_t)>& value) {
    ExrChannel channel{std::move(name), type, std::vector<float>(pixels), {}};
    for (size_t p = 0; p < pixels; ++p) channel.pixels[p] = value(first_pixel + p);
    channels.push_back(std::move(channel));
  };
  const auto add_color = [&](const std::string& prefix, size_t first) {
    for (size_t c = 0; c < 3; ++c) {
      add_channel(prefix + "RGB"[c], ChannelType::kHalf, [&, c](size_t p) { return average(p, first + c); });
    }
  };
  const auto add_data = [&](std::string name, auto value) {
    add_channel(std::move(name), ChannelType::kFloat, [&](size_t p) { return value(surfaces_[p].sample); });
  };

  add_color("", 0);
  add_channel("A", ChannelType::kHalf, [&](size_t p) { return average(p, 3); });
  for (size_t i = 0; i < layers_.size(); ++i) add_color(layers_.names[i] + ".", 4 + 3 * i);
  add_data("Z", [](const VisibleSurface& s) { return s.depth; });
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "XYZ"[c]);
    add_data("N." + axis, [c](const VisibleSurface& s) { return s.normal[c]; });
    add_data("tangent." + axis, [c](const VisibleSurface& s) { return s.tangent[c]; });
  }
  for (int c = 0; c < 2; ++c) {
    const std::string axis(1, "uv"[c]);
    add_data("forward." + axis, [c](const VisibleSurface& s) { return s.forward[c]; });
    add_data("root." + axis, [c](const VisibleSurface& s) { return s.root_uv[c]; });
  }
  ExrChannel id{"id", ChannelType::kUint, {}, std::vector<uint32_t>(pixels)};
  for (size_t p = 0; p < pixels; ++p) id.ids[p] = surfaces_[first_pixel + p].sample.id;
  channels.push_back(std::move(id));
  if (layers_.lod) add_data("lod", [](const VisibleSurface& s) { return s.left_out; });
  if (!moments_.empty()) {
    add_channel("noise", ChannelType::kFloat,
                [&](size_t p) { return static_cast<float>(moments_[p].error()); });
    const auto begin = counts_.begin() + static_cast<std::ptrdiff_t>(first_pixel);
    channels.push_back(
        {"samples", ChannelType::kUint, {}, {begin, begin + static_cast<std::ptrdiff_t>(pixels)}});
  }
  return channels;
}

}  // namespace pelage
