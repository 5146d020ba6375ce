// SPDX-License-Identifier: Apache-2.0
#include "render/film/film.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <type_traits>

#include "base/check.h"
#include "render/film/positive_layers.h"

namespace pelage {
namespace {

bool is_finite(const Rgb& c) { return std::isfinite(c.x + c.y + c.z); }

bool all_finite(std::span<const Rgb> colors) { return std::all_of(colors.begin(), colors.end(), is_finite); }

bool all_zero(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return v == 0; });
}

/// The channels of light layers, one after the other.
std::span<const float> channels_of(std::span<const Rgb> by_layer) {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  return {by_layer.empty() ? nullptr : &by_layer.front().x, 3 * by_layer.size()};
}

/// A layer minus its direct part. A small negative difference is the rounding error of the two sums and
/// becomes 0; in half precision, it would not show in the layer.
float rest_of(float layer, float direct) {
  constexpr float kRounding = 1e-4f;
  const float rest = layer - direct;
  return rest < 0 && rest > -kRounding * layer ? 0.0f : rest;
}

}  // namespace

Film::Film(int width, int height, FilmLayers layers, MemoryLedger& ledger)
    : width_(width),
      height_(height),
      layers_(std::move(layers)),
      sums_(width, height, channel_count(layers_), layers_.splat) {
  const size_t pixels = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  charge_ = MemoryCharge(ledger, MemoryTag::kFilm, bytes_needed(width, height, layers_));
  counts_.resize(pixels);
  surfaces_.resize(pixels);
  if (layers_.noise) moments_.resize(pixels);
}

int64_t Film::bytes_needed(int width, int height, const FilmLayers& layers) {
  const size_t pixel = sizeof(uint32_t) + sizeof(FrontSurface) + (layers.noise ? sizeof(PixelMoments) : 0);
  const size_t sums = FilmSums::bytes_needed(width, height, channel_count(layers), layers.splat);
  return static_cast<int64_t>(width) * height * static_cast<int64_t>(pixel) + static_cast<int64_t>(sums);
}

bool Film::add(int x, int y, const FilmSample& sample, std::span<const Rgb> by_layer) {
  PELAGE_CHECK(by_layer.size() == layers_.size());
  const size_t pixel = index(x, y);
  ++counts_[pixel];
  if (!is_finite(sample.radiance) || !std::isfinite(sample.alpha) || !all_finite(by_layer)) return false;
  const float light[] = {sample.radiance.x, sample.radiance.y, sample.radiance.z, sample.alpha};
  const FilmSums::Footprint footprint = sums_.footprint(sample.offset);
  const std::span<const float> layers = channels_of(by_layer);
  if (!all_zero(light) || !all_zero(layers)) {
    sums_.add(x, y, footprint, light, layers);
  }
  sums_.add_weight(x, y, footprint);
  surfaces_[pixel].offer(sample.surface, sample.inside_pixel());
  return true;
}

uint32_t Film::min_samples(const PixelBox& box) const {
  uint32_t min = std::numeric_limits<uint32_t>::max();
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) min = std::min(min, samples(x, y));
  }
  return min;
}

double Film::sample_sum(const PixelBox& box) const {
  double sum = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) sum += samples(x, y);
  }
  return sum;
}

std::vector<std::span<std::byte>> Film::state() {
  // Any bytes are valid values of their members, which are numbers.
  static_assert(std::is_standard_layout_v<FrontSurface> && sizeof(FrontSurface) == 14 * sizeof(float));
  static_assert(std::is_standard_layout_v<PixelMoments> && sizeof(PixelMoments) == 24);
  return {std::as_writable_bytes(sums_.values()), std::as_writable_bytes(std::span(counts_)),
          std::as_writable_bytes(std::span(surfaces_)), std::as_writable_bytes(std::span(moments_))};
}

Rgb Film::radiance(int x, int y) const { return {mean(x, y, 0), mean(x, y, 1), mean(x, y, 2)}; }

float Film::alpha(int x, int y) const { return mean(x, y, 3); }

Rgb Film::layer(int x, int y, size_t layer) const {
  const size_t c = first_channel(layer);
  return {mean(x, y, c), mean(x, y, c + 1), mean(x, y, c + 2)};
}

Rgb Film::indirect(int x, int y, size_t light, int group) const {
  const Rgb all = layer(x, y, layers_.scattered(light, group));
  const Rgb direct = layer(x, y, layers_.direct(light, group));
  return {rest_of(all.x, direct.x), rest_of(all.y, direct.y), rest_of(all.z, direct.z)};
}

std::vector<ExrChannel> Film::exr_pixels(const PixelBox& box,
                                         const std::function<bool(const std::string&)>& wanted) const {
  std::vector<size_t> indices;  // of the pixels of the box
  indices.reserve(static_cast<size_t>(box.width()) * static_cast<size_t>(box.height()));
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) indices.push_back(index(x, y));
  }
  const size_t pixels = indices.size();
  std::vector<ExrChannel> channels;
  const auto add_channel = [&](std::string name, ChannelType type,
                               const std::function<float(size_t)>& value) {
    if (wanted && !wanted(name)) return;
    ExrChannel channel{std::move(name), type, std::vector<float>(pixels), {}};
    for (size_t p = 0; p < pixels; ++p) channel.pixels[p] = value(indices[p]);
    channels.push_back(std::move(channel));
  };
  const auto mean = [&](size_t pixel, size_t channel) {
    const size_t columns = static_cast<size_t>(width_);
    return this->mean(static_cast<int>(pixel % columns), static_cast<int>(pixel / columns), channel);
  };
  const auto add_color = [&](const std::string& prefix, size_t first) {
    for (size_t c = 0; c < 3; ++c) {
      add_channel(prefix + "RGB"[c], ChannelType::kHalf, [&, c](size_t p) { return mean(p, first + c); });
    }
  };
  const auto add_indirect = [&](size_t light, int group) {
    const std::string prefix = layers_.names[layers_.scattered(light, group)] + ".indirect.";
    const size_t all = first_channel(layers_.scattered(light, group));
    const size_t direct = first_channel(layers_.direct(light, group));
    for (size_t c = 0; c < 3; ++c) {
      add_channel(prefix + "RGB"[c], ChannelType::kHalf,
                  [&, c](size_t p) { return rest_of(mean(p, all + c), mean(p, direct + c)); });
    }
  };
  const auto add_data = [&](std::string name, auto value) {
    add_channel(std::move(name), ChannelType::kFloat, [&](size_t p) { return value(surfaces_[p].surface); });
  };

  const auto add_counts = [&](std::string name, auto value) {
    if (wanted && !wanted(name)) return;
    ExrChannel channel{std::move(name), ChannelType::kUint, {}, std::vector<uint32_t>(pixels)};
    for (size_t p = 0; p < pixels; ++p) channel.ids[p] = value(indices[p]);
    channels.push_back(std::move(channel));
  };

  add_color("", 0);
  add_channel("A", ChannelType::kHalf, [&](size_t p) { return mean(p, 3); });
  for (size_t i = 0; i < layers_.size(); ++i) add_color(layers_.names[i] + ".", first_channel(i));
  for (size_t i = 0; layers_.events && i < layers_.lights(); ++i) {
    for (int g = 0; g < layers_.groups; ++g) add_indirect(i, g);
  }
  if (!wanted) make_positive(layers_, channels);
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
  add_counts("id", [&](size_t p) { return surfaces_[p].surface.id; });
  add_data("id.X", [](const VisibleSurface& s) { return id_float(s.id); });
  if (layers_.lod) add_data("lod", [](const VisibleSurface& s) { return s.left_out; });
  if (!moments_.empty()) {
    add_channel("noise", ChannelType::kFloat,
                [&](size_t p) { return static_cast<float>(moments_[p].error()); });
    add_counts("samples", [&](size_t p) { return counts_[p]; });
  }
  return channels;
}

}  // namespace pelage
