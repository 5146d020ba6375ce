// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/host_data.h"
#include "image/image_sink.h"

namespace pelage {

/// An image that a host made, in place of the file of a map: `map`, or the `file` of a light. As in a file,
/// rows run from the top, and `space: auto` decodes integers from sRGB where they are colours.
class HostImage final : public HostData {
 public:
  HostImage(std::string name, const TexelLayout& layout, std::vector<std::byte> texels)
      : HostData(std::move(name)), layout_(layout), texels_(std::move(texels)) {}
  const TexelLayout& layout() const { return layout_; }
  /// Passes the image to a sink, in strips.
  void read(ImageSink& sink) const;

 private:
  TexelLayout layout_;
  std::vector<std::byte> texels_;
};

/// Makes an image known to scenes, as if a file had it. `texels`: layout.bytes() bytes, rows from the top,
/// the 1 to 4 channels of a texel side by side. Throws Error (kInput) if they do not fit the layout. Values
/// that are not finite are errors of the map that reads them.
std::shared_ptr<const HostImage> share_image(const TexelLayout& layout, std::vector<std::byte> texels);

}  // namespace pelage
