// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "base/vector.h"
#include "image/image.h"
#include "image/texel_decoder.h"
#include "image/texel_store.h"

namespace pelage {

/// An image looked up by texture coordinates: u to the right, v up, (0, 0) the lower left corner, repeated.
/// Lookups give the same values whether the texels are in memory or in tiles, and throw Error (kFailed) when
/// tiles cannot be read back. Immutable. Thread safety: const members may be called from any thread.
class Texture {
 public:
  /// With `srgb`, all channels except alpha are decoded before filtering.
  Texture(std::shared_ptr<const TexelStore> texels, bool srgb);
  /// Float texels, used as they are.
  explicit Texture(const Image& image);

  int width() const { return texels_->layout().width; }
  int height() const { return texels_->layout().height; }
  int channels() const { return texels_->layout().channels; }
  /// Min and max of a channel.
  std::pair<float, float> range(int channel) const;

  /// Bilinear lookup of one channel / of the first three (a single channel is repeated).
  float channel(float u, float v, int channel) const;
  Rgb color(float u, float v) const;

  /// The colours of a rectangle of texels inside the image, row by row from the top.
  void colors(int x, int y, int width, int height, Rgb* to) const;
  Rgb texel(int x, int y) const;

  /// Without the texels, which several textures may share.
  size_t bytes() const { return decode_.bytes(); }

 private:
  struct Tap;
  class Corners;
  static Tap tap(float coordinate, int size);
  Rgb decoded(const std::byte* texel) const;

  std::shared_ptr<const TexelStore> texels_;
  TexelDecoder decode_;
};

}  // namespace pelage
