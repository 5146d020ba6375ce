// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/ledger.h"
#include "base/progress.h"
#include "base/value_readers.h"
#include "image/texture.h"

namespace pelage {

class ImageReader;
class TileCache;

/// How stored values are converted to linear ones.
enum class ColorSpace { kAuto, kLinear, kSrgb };
template <>
struct EnumNames<ColorSpace> {
  static constexpr const char* names[] = {"auto", "linear", "srgb"};
};

/// Reads images of any format that OpenImageIO supports, using a module that is loaded for the first image
/// (linking it would cost 0.3 s and 130 MB at every start). Keeps one copy of the texels per file, in the
/// type that the file stores.
///
/// With a ledger limit, images stay in memory as long as all images together take at most a quarter of the
/// limit. Each further image becomes a temporary file of tiles; a cache of an eighth of the limit holds the
/// recently used ones. Both give the same values. Thread safety: all members may be called from any thread.
class TextureLibrary {
 public:
  /// `progress` shows the reading of large images and may stop it. Both arguments must outlive the library.
  explicit TextureLibrary(MemoryLedger& ledger, Progress* progress = nullptr);
  ~TextureLibrary();

  /// Throws at `asset.position`, naming the file: Error (kInput) when it is missing or unreadable (a missing
  /// texture is never black), Error (kMemory) before reading anything when it does not fit the ledger's
  /// limit, Error (kStopped) once the user has asked to stop.
  std::shared_ptr<const Texture> load(const AssetPath& asset, ColorSpace space = ColorSpace::kAuto);

  /// Throws Error (kStopped) once the user has asked to stop.
  void check_stop() const;

 private:
  class TextureSink;
  struct Stored {
    std::shared_ptr<const TexelStore> texels;
    bool is_integer = false;
    MemoryCharge charge;
  };
  struct Entry {
    std::shared_ptr<const Texture> texture;
    MemoryCharge charge;
  };
  const Stored& stored(const AssetPath& asset, const std::filesystem::path& path);
  const ImageReader& reader();
  std::shared_ptr<TileCache> tile_cache();

  MemoryLedger& ledger_;
  Progress* progress_;
  std::mutex mutex_;  // guards the rest
  std::unique_ptr<ImageReader> reader_;
  MemoryCharge library_charge_;
  std::shared_ptr<TileCache> tiles_;
  MemoryCharge tiles_charge_;
  int64_t in_memory_ = 0;  // total bytes of the images that are in memory
  std::map<std::filesystem::path, Stored> stored_;
  std::map<std::pair<std::filesystem::path, bool>, Entry> entries_;  // by file and whether sRGB is decoded
};

}  // namespace pelage
