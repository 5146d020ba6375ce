// SPDX-License-Identifier: Apache-2.0
#include "image/image_reader.h"

#include <exception>

#include "base/error.h"

namespace pelage {
namespace {

/// A sink behind the C interface: stores exceptions until the module has returned.
struct GuardedSink {
  ImageSink& sink;
  std::exception_ptr error;

  template <class Call>
  int guarded(Call&& call) {
    try {
      call();
      return 0;
    } catch (...) {
      error = std::current_exception();
      return 1;
    }
  }
  static int begin(void* context, const PelageImageInfo* info) {
    auto& self = *static_cast<GuardedSink*>(context);
    return self.guarded([&] {
      constexpr TexelKind kKinds[] = {TexelKind::kU8, TexelKind::kU16, TexelKind::kHalf, TexelKind::kFloat};
      self.sink.begin({{info->width, info->height, info->channels, kKinds[info->kind]},
                       info->is_integer != 0,
                       info->working_bytes});
    });
  }
  static int rows(void* context, const void* rows, int count) {
    auto& self = *static_cast<GuardedSink*>(context);
    return self.guarded([&] { self.sink.rows(static_cast<const std::byte*>(rows), count); });
  }
};

}  // namespace

ImageReader::ImageReader() : module_("pelage_image_reader") {
  decltype(&pelage_image_reader_version) version = nullptr;
  find(version, "pelage_image_reader_version");
  if (version() != PELAGE_IMAGE_READER_VERSION) {
    throw Error(ErrorKind::kFailed, "module pelage_image_reader belongs to another version of Pelage");
  }
  find(read_, "pelage_read_image");
  find(write_, "pelage_write_image");
}

std::string ImageReader::read(const std::filesystem::path& file, ImageSink& sink) const {
  GuardedSink guarded{sink, nullptr};
  const PelageImageSink border{&guarded, GuardedSink::begin, GuardedSink::rows};
  char message[512] = "";
  const int failed = read_(file.c_str(), &border, message, sizeof message);
  if (guarded.error) std::rethrow_exception(guarded.error);
  if (!failed) return {};
  return message[0] ? message : "cannot be decoded";
}

std::string ImageReader::write(const std::filesystem::path& file, const DisplayImage& image) const {
  char message[512] = "";
  if (!write_(file.c_str(), image.width, image.height, image.pixels.data(), message, sizeof message))
    return {};
  return message[0] ? message : "cannot be encoded";
}

/// Keeps the cache and its file alive.
class TileCache::Store final : public TexelStore {
 public:
  Store(std::shared_ptr<const TileCache> cache, std::string name, const TexelLayout& layout,
        std::vector<NumberRange> ranges, std::unique_ptr<TileFile> tiles, PelageTileImage* image)
      : TexelStore(layout, std::move(ranges)),
        cache_(std::move(cache)),
        name_(std::move(name)),
        tiles_(std::move(tiles)),
        image_(image) {}

  void read(int x, int y, int width, int height, std::byte* to) const override {
    if (cache_->read_(image_, x, y, width, height, to) != 0) {
      throw Error(ErrorKind::kFailed,
                  name_ + ": its temporary tile file cannot be read back (TMPDIR names the folder)");
    }
  }

 private:
  std::shared_ptr<const TileCache> cache_;
  std::string name_;
  std::unique_ptr<TileFile> tiles_;
  PelageTileImage* image_;
};

TileCache::TileCache(const ImageReader& reader, int64_t bytes) {
  decltype(&pelage_tile_cache_create) create = nullptr;
  reader.find(create, "pelage_tile_cache_create");
  reader.find(destroy_, "pelage_tile_cache_destroy");
  reader.find(add_, "pelage_tile_cache_add");
  reader.find(read_, "pelage_tile_cache_read");
  cache_ = create(bytes);
  if (!cache_) throw Error(ErrorKind::kFailed, "cannot create a cache of texture tiles");
}

// The module stays loaded (it is linked with nodelete), so that stores may outlive the reader.
TileCache::~TileCache() { destroy_(cache_); }

std::unique_ptr<TexelStore> TileCache::store(std::string name, const TexelLayout& layout,
                                             std::vector<NumberRange> ranges,
                                             std::unique_ptr<TileFile> tiles) {
  const PelageTiles border{tiles->descriptor(), layout.width, layout.height, kTileSide,
                           static_cast<int>(layout.texel_bytes())};
  PelageTileImage* image = add_(cache_, &border);
  if (!image) throw Error(ErrorKind::kFailed, name + ": cannot be added to the cache of texture tiles");
  return std::make_unique<Store>(shared_from_this(), std::move(name), layout, std::move(ranges),
                                 std::move(tiles), image);
}

}  // namespace pelage
