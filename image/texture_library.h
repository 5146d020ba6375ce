// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/file_stamp.h"
#include "base/ledger.h"
#include "base/progress.h"
#include "base/value_readers.h"
#include "image/texture.h"

namespace pelage {

class ImageReader;
class TileCache;

/// Conversion of the stored values of an image to linear values. kAuto: from sRGB if the file stores
/// integers, else none.
enum class ColorSpace { kAuto, kLinear, kSrgb };
template <>
struct EnumNames<ColorSpace> {
  static constexpr const char* names[] = {"auto", "linear", "srgb"};
};

/// Reads images of any format that OpenImageIO supports. OpenImageIO is in a module that is loaded for the
/// first image that is neither a plain PNG nor a Radiance file, or does not stay in memory, because linking
/// it to the program would cost 0.3 s and 130 MB at every start. The library keeps one copy of the texels of
/// each file, in the type in which the file stores them.
///
/// Without a ledger limit, all images stay in memory. With a limit, an image stays in memory if all images in
/// memory then take at most a quarter of the limit and there is room for this image. Any other image becomes
/// a temporary file of tiles, and a cache of an eighth of the limit holds the most recently used tiles.
/// Textures have the same values in both cases. Thread safety: all members may be called from any thread.
class TextureLibrary {
 public:
  /// `progress`, if not null, shows the reading of large images and may cancel it. Both arguments must
  /// outlive the library.
  explicit TextureLibrary(MemoryLedger& ledger, Progress* progress = nullptr);
  ~TextureLibrary();

  /// Returns the texture of a file, or of an image of the host (image/host_image.h). Reads the file if this
  /// library has not read it yet. Throws Error: kInput when the file is missing, damaged or has non-finite
  /// values (there is no black default texture), kMemory (before any pixel is read) when the image does not
  /// fit the ledger's limit, kFailed when the temporary file or the module fails, kStopped once the user has
  /// asked to stop. Except for kStopped, the error has the position `asset.position` and names the file.
  std::shared_ptr<const Texture> load(const AssetPath& asset, ColorSpace space = ColorSpace::kAuto);

  /// Forgets the images whose files have changed, so that load() reads them again. Textures that are in use
  /// keep their texels.
  void forget_changed();
  /// Forgets the images of which no texture is in use, and frees their memory.
  void forget_unused();

  /// Throws Error (kStopped) once the user has asked to stop.
  void check_stop() const;

 private:
  class TextureSink;
  struct Stored {
    std::shared_ptr<const TexelStore> texels;
    bool is_integer = false;
    int64_t in_memory = 0;  // bytes of in_memory_
    FileStamp stamp;        // before the file was read
    MemoryCharge charge;
  };
  struct Entry {
    std::shared_ptr<const Texture> texture;
    MemoryCharge charge;
  };
  template <class IsOld>
  void forget(const IsOld& is_old);
  const Stored& stored(const AssetPath& asset, const std::filesystem::path& path);
  const Stored& shared(const AssetPath& asset);  // an image of the host
  const ImageReader& reader();
  std::shared_ptr<TileCache> tile_cache();

  MemoryLedger& ledger_;
  Progress* progress_;
  std::mutex mutex_;  // guards all members below
  std::unique_ptr<ImageReader> reader_;
  MemoryCharge library_charge_;
  std::shared_ptr<TileCache> tiles_;
  MemoryCharge tiles_charge_;
  int64_t in_memory_ = 0;  // total bytes of the images that are in memory
  std::map<std::filesystem::path, Stored> stored_;
  std::map<std::pair<std::filesystem::path, bool>, Entry> entries_;  // by file and whether sRGB is decoded
};

}  // namespace pelage
