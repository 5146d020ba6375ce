// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/ledger.h"
#include "base/value_readers.h"
#include "image/image.h"

namespace pelage {

/// How stored values become linear ones.
enum class ColorSpace { kAuto, kLinear, kSrgb };
template <>
struct EnumNames<ColorSpace> {
  static constexpr const char* names[] = {"auto", "linear", "srgb"};
};

/// An image looked up by texture coordinates: u to the right, v up, (0, 0) the lower left corner, repeated.
class Texture {
 public:
  explicit Texture(Image image) : image_(std::move(image)) {}
  const Image& image() const { return image_; }
  /// Bilinear lookup of one channel / of the first three (one channel is spread to three).
  float channel(float u, float v, int channel) const;
  Rgb color(float u, float v) const;

 private:
  Image image_;
};

/// Reads images of any format that OpenImageIO knows, through a module that is loaded when the first image is
/// asked for (linking it would cost every start 0.3 s and 130 MB). One copy per file and colour space.
/// Thread safety: all members may be called from any thread.
class TextureLibrary {
 public:
  explicit TextureLibrary(MemoryLedger& ledger);
  ~TextureLibrary();

  /// Throws Error (kInput) at `asset.position` naming the file when it is missing or cannot be read: never
  /// black.
  std::shared_ptr<const Texture> load(const AssetPath& asset, ColorSpace space = ColorSpace::kAuto);

 private:
  struct Reader;
  struct Entry {
    std::shared_ptr<const Texture> texture;
    MemoryCharge charge;
  };
  MemoryLedger& ledger_;
  std::mutex mutex_;  // guards the rest
  std::unique_ptr<Reader> reader_;
  MemoryCharge library_charge_;
  std::map<std::pair<std::filesystem::path, ColorSpace>, Entry> entries_;
};

}  // namespace pelage
