// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/vector.h"
#include "image/texel_decoder.h"
#include "image/texel_store.h"

namespace pelage {

/// An image of linear floating-point pixels. Rows run from the top; the channels of a pixel are adjacent.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> pixels;  ///< width * height * channels values

  const float* at(int x, int y) const {
    return &pixels[(static_cast<size_t>(y) * width + x) * static_cast<size_t>(channels)];
  }
  float* at(int x, int y) { return const_cast<float*>(static_cast<const Image*>(this)->at(x, y)); }
  size_t bytes() const { return pixels.size() * sizeof(float); }
};

/// What a texture is outside its image.
enum class TextureWrap {
  kClamp,   ///< the border of the image: opposite borders never mix
  kRepeat,  ///< the image again
};

/// An image that is looked up by texture coordinates. u points right and v points up; the lower left corner
/// of the image is (0, 0), the upper right one (1, 1). Lookups give the same values whether the texels are in
/// memory or in a file of tiles. They throw Error (kFailed) when a tile cannot be read. Immutable. Thread
/// safety: const members may be called from any thread.
class Texture {
 public:
  /// `srgb`: whether all channels except alpha are decoded from sRGB, which happens before filtering.
  Texture(std::shared_ptr<const TexelStore> texels, bool srgb);
  /// Copies float texels and does not decode them.
  explicit Texture(const Image& image);

  int width() const { return texels_->layout().width; }
  int height() const { return texels_->layout().height; }
  int channels() const { return texels_->layout().channels; }
  /// Returns the min and max of the texels of a channel, as linear values.
  std::pair<float, float> range(int channel) const;

  /// Looks up one channel with bilinear interpolation.
  float channel(float u, float v, int channel, TextureWrap wrap = TextureWrap::kClamp) const;
  /// Looks up the first three channels with bilinear interpolation. If the image has only one or two
  /// channels, returns the first channel three times.
  Rgb color(float u, float v, TextureWrap wrap = TextureWrap::kClamp) const;

  /// Copies the linear colours of a rectangle of texels inside the image to `to`, row by row from the top.
  void colors(int x, int y, int width, int height, Rgb* to) const;
  /// Returns the linear colour of one texel; (0, 0) is the upper left one.
  Rgb texel(int x, int y) const;

  /// Heap memory in bytes, without the texels, because several textures may share them.
  size_t bytes() const { return decode_.bytes(); }

 private:
  struct Tap;
  class Corners;
  static Tap tap(float coordinate, int size, TextureWrap wrap);
  Rgb decoded(const std::byte* texel) const;

  std::shared_ptr<const TexelStore> texels_;
  TexelDecoder decode_;
};

}  // namespace pelage
