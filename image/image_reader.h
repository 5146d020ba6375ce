// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/module.h"
#include "image/display_image.h"
#include "image/image_sink.h"
#include "image/reader_module.h"
#include "image/texel_store.h"
#include "image/tile_file.h"

namespace pelage {

/// Reads and writes image files through the module of image/reader_module.h, which contains OpenImageIO.
/// Thread safety: const members may be called from any thread.
class ImageReader {
 public:
  /// Loads the module. Throws Error (kFailed) when the module cannot be loaded or has another version.
  ImageReader();

  /// Passes the first image of a file to `sink`. Returns an empty string on success, otherwise a description
  /// of the problem with the file. Exceptions of the sink propagate.
  std::string read(const std::filesystem::path& file, ImageSink& sink) const;

  /// Writes a picture in the format that the extension of `file` states. Returns an empty string on success,
  /// otherwise a description of the problem.
  std::string write(const std::filesystem::path& file, const DisplayImage& image) const;

 private:
  friend class TileCache;
  template <class Function>
  void find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(module_.symbol(name));
  }

  Module module_;
  decltype(&pelage_read_image) read_ = nullptr;
  decltype(&pelage_write_image) write_ = nullptr;
};

/// A cache of tiles of images. Keeps the most recently used tiles within a fixed amount of memory. Thread
/// safety: all members may be called from any thread.
class TileCache : public std::enable_shared_from_this<TileCache> {
 public:
  /// `bytes`: max memory of the tiles; values below kSmallest are raised to kSmallest. Throws Error (kFailed)
  /// when the cache cannot be made.
  TileCache(const ImageReader& reader, int64_t bytes);
  ~TileCache();
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  /// Returns an image whose texels are read from `tiles` through this cache. All rows must have been added to
  /// `tiles`. `ranges`: min and max of each channel. `name`: name of the image for messages. Throws Error
  /// (kFailed).
  std::unique_ptr<TexelStore> store(std::string name, const TexelLayout& layout,
                                    std::vector<NumberRange> ranges, std::unique_ptr<TileFile> tiles);
  /// Smallest max memory that a cache can respect, in bytes.
  static constexpr int64_t kSmallest = PELAGE_SMALLEST_TILE_CACHE;

 private:
  class Store;
  decltype(&pelage_tile_cache_destroy) destroy_ = nullptr;
  decltype(&pelage_tile_cache_add) add_ = nullptr;
  decltype(&pelage_tile_cache_read) read_ = nullptr;
  PelageTileCache* cache_ = nullptr;
};

}  // namespace pelage
