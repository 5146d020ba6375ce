// SPDX-License-Identifier: Apache-2.0
#include "image/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/check.h"

namespace pelage {
namespace {

std::shared_ptr<const TexelStore> float_texels(const Image& image) {
  const TexelLayout layout{image.width, image.height, image.channels, TexelKind::kFloat};
  std::vector<std::byte> bytes(layout.bytes());
  if (!bytes.empty()) std::memcpy(bytes.data(), image.pixels.data(), bytes.size());
  std::vector<NumberRange> ranges;
  for (int c = 0; c < image.channels; ++c) {
    NumberRange range(image.pixels[static_cast<size_t>(c)], image.pixels[static_cast<size_t>(c)]);
    for (auto i = static_cast<size_t>(c); i < image.pixels.size(); i += static_cast<size_t>(image.channels)) {
      range = {std::min(range.first, image.pixels[i]), std::max(range.second, image.pixels[i])};
    }
    ranges.push_back(range);
  }
  return std::make_shared<TexelsInMemory>(layout, std::move(ranges), std::move(bytes));
}

}  // namespace

/// Sample positions and weight of a bilinear lookup along one axis of `size` texels.
struct Texture::Tap {
  int a = 0, b = 0;
  float t = 0;
};

Texture::Tap Texture::tap(float coordinate, int size, TextureWrap wrap) {
  if (!std::isfinite(coordinate)) return {};
  if (wrap == TextureWrap::kClamp) {
    const auto last = static_cast<float>(size - 1);
    const float x = std::clamp(coordinate * static_cast<float>(size) - 0.5f, 0.0f, last);
    const int i = static_cast<int>(x);
    return {i, std::min(i + 1, size - 1), x - std::floor(x)};
  }
  const float wrapped = coordinate - std::floor(coordinate);
  const float x = wrapped * static_cast<float>(size) - 0.5f;
  const int i = static_cast<int>(std::floor(x));  // -1 .. size - 1, or size where wrapped rounds to 1
  return {(i + size) % size, (i + 1) % size, x - std::floor(x)};
}

/// The four texels of a bilinear lookup: pointers into memory, or copies.
class Texture::Corners {
 public:
  Corners(const TexelStore& texels, const Tap& x, const Tap& y) : x_(x.t), y_(y.t) {
    const size_t texel = texels.layout().texel_bytes();
    if (const std::byte* all = texels.in_memory()) {
      const std::byte* low = all + static_cast<size_t>(y.a) * texels.layout().row_bytes();
      const std::byte* high = all + static_cast<size_t>(y.b) * texels.layout().row_bytes();
      const size_t a = static_cast<size_t>(x.a) * texel, b = static_cast<size_t>(x.b) * texel;
      at_ = {low + a, low + b, high + a, high + b};
      return;
    }
    for (size_t i = 0; i < 4; ++i) at_[i] = copies_.data() + i * texel;
    if (x.b == x.a + 1 && y.b == y.a + 1) {
      texels.read(x.a, y.a, 2, 2, copies_.data());
      return;
    }
    for (size_t i = 0; i < 4; ++i) {
      texels.read(i % 2 ? x.b : x.a, i / 2 ? y.b : y.a, 1, 1, copies_.data() + i * texel);
    }
  }

  float filtered(const TexelDecoder& decode, int channel) const {
    const float low = decode(at_[0], channel) * (1 - x_) + decode(at_[1], channel) * x_;
    const float high = decode(at_[2], channel) * (1 - x_) + decode(at_[3], channel) * x_;
    return low * (1 - y_) + high * y_;
  }

 private:
  float x_, y_;
  std::array<const std::byte*, 4> at_;
  std::array<std::byte, 4 * kMaxTexelBytes> copies_;
};

Texture::Texture(std::shared_ptr<const TexelStore> texels, bool srgb)
    : texels_(std::move(texels)), decode_(texels_->layout(), srgb) {}

Texture::Texture(const Image& image) : Texture(float_texels(image), false) {}

std::pair<float, float> Texture::range(int channel) const {
  const auto [low, high] = texels_->range(channel);
  return {decode_.linear(low, channel), decode_.linear(high, channel)};
}

float Texture::channel(float u, float v, int channel, TextureWrap wrap) const {
  PELAGE_CHECK(channel >= 0 && channel < channels());
  return Corners(*texels_, tap(u, width(), wrap), tap(1 - v, height(), wrap)).filtered(decode_, channel);
}

Rgb Texture::color(float u, float v, TextureWrap wrap) const {
  const Corners corners(*texels_, tap(u, width(), wrap), tap(1 - v, height(), wrap));
  if (channels() < 3) return Rgb(corners.filtered(decode_, 0));
  return {corners.filtered(decode_, 0), corners.filtered(decode_, 1), corners.filtered(decode_, 2)};
}

Rgb Texture::decoded(const std::byte* texel) const {
  if (channels() < 3) return Rgb(decode_(texel, 0));
  return {decode_(texel, 0), decode_(texel, 1), decode_(texel, 2)};
}

void Texture::colors(int x, int y, int width, int height, Rgb* to) const {
  const size_t texel = texels_->layout().texel_bytes();
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  std::array<std::byte, 4096> few;
  std::vector<std::byte> many(count * texel > few.size() ? count * texel : 0);
  std::byte* bytes = many.empty() ? few.data() : many.data();
  texels_->read(x, y, width, height, bytes);
  for (size_t i = 0; i < count; ++i) to[i] = decoded(bytes + i * texel);
}

Rgb Texture::texel(int x, int y) const {
  const TexelLayout& layout = texels_->layout();
  if (const std::byte* all = texels_->in_memory()) {
    return decoded(all + static_cast<size_t>(y) * layout.row_bytes() +
                   static_cast<size_t>(x) * layout.texel_bytes());
  }
  std::array<std::byte, kMaxTexelBytes> copy;
  texels_->read(x, y, 1, 1, copy.data());
  return decoded(copy.data());
}

}  // namespace pelage
