// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/module.h"
#include "image/reader_module.h"
#include "image/texel_store.h"
#include "image/tile_file.h"

namespace pelage {

/// Header of an image file.
struct ImageHeader {
  TexelLayout layout;
  bool is_integer = false;    ///< stored as integers
  int64_t working_bytes = 0;  ///< estimated temporary memory of reading
};

/// Receives an image in strips of rows from the top. Both functions may throw, which ends reading.
class ImageSink {
 public:
  virtual ~ImageSink() = default;
  virtual void begin(const ImageHeader& header) = 0;
  virtual void rows(const std::byte* rows, int count) = 0;
};

/// C++ interface of the module that reads images (image/reader_module.h). Thread safety: const members may be
/// called from any thread.
class ImageReader {
 public:
  /// Loads the module. Throws Error (kFailed).
  ImageReader();

  /// Reads the first image of a file. Returns the problem with the file, or an empty string; exceptions of
  /// the sink propagate.
  std::string read(const std::filesystem::path& file, ImageSink& sink) const;

 private:
  friend class TileCache;
  template <class Function>
  void find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(module_.symbol(name));
  }

  Module module_;
  decltype(&pelage_read_image) read_ = nullptr;
};

/// Recently used tiles of images, in a fixed amount of memory. Thread safety: all members may be called from
/// any thread.
class TileCache : public std::enable_shared_from_this<TileCache> {
 public:
  /// Throws Error (kFailed).
  TileCache(const ImageReader& reader, int64_t bytes);
  ~TileCache();
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  /// An image with the texels of `tiles`, which must be complete. `name`: for messages. Throws Error
  /// (kFailed).
  std::unique_ptr<TexelStore> store(std::string name, const TexelLayout& layout,
                                    std::vector<NumberRange> ranges, std::unique_ptr<TileFile> tiles);
  static constexpr int64_t kSmallest = PELAGE_SMALLEST_TILE_CACHE;

 private:
  class Store;
  decltype(&pelage_tile_cache_destroy) destroy_ = nullptr;
  decltype(&pelage_tile_cache_add) add_ = nullptr;
  decltype(&pelage_tile_cache_read) read_ = nullptr;
  PelageTileCache* cache_ = nullptr;
};

}  // namespace pelage
