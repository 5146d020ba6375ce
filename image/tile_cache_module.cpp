// SPDX-License-Identifier: Apache-2.0
// Tiles in OpenImageIO's image cache, which keeps recently used ones within a memory limit.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include "image/reader_module.h"

namespace {

/// Provides a file of tiles (PelageTiles) to the image cache, with each texel as one-byte channels, because
/// the cache passes bytes unchanged.
class TileInput final : public OIIO::ImageInput {
 public:
  static OIIO::ImageInput* create() { return new TileInput; }
  static OIIO::ImageSpec configuration(const PelageTiles& tiles) {
    OIIO::ImageSpec config;
    config["pelage:descriptor"] = tiles.descriptor;
    config["pelage:width"] = tiles.width;
    config["pelage:height"] = tiles.height;
    config["pelage:side"] = tiles.side;
    config["pelage:texel_bytes"] = tiles.texel_bytes;
    return config;
  }

  const char* format_name() const override { return "pelage-tiles"; }
  bool open(const std::string&, OIIO::ImageSpec&) override { return false; }
  bool open(const std::string&, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) override {
    const auto number = [&](const char* name) { return config.get_int_attribute(name, -1); };
    descriptor_ = number("pelage:descriptor");
    const int side = number("pelage:side");
    if (descriptor_ < 0 || side < 1) return false;
    m_spec = OIIO::ImageSpec(number("pelage:width"), number("pelage:height"), number("pelage:texel_bytes"),
                             OIIO::TypeDesc::UINT8);
    m_spec.tile_width = m_spec.tile_height = side;
    m_spec.tile_depth = 1;
    spec = m_spec;
    return true;
  }
  bool close() override { return true; }

  bool read_native_scanline(int, int, int, int, void*) override { return false; }
  bool read_native_tile(int, int, int x, int y, int, void* data) override {
    const auto side = static_cast<int64_t>(m_spec.tile_width);
    const int64_t across = (m_spec.width + side - 1) / side;
    const int64_t size = side * side * m_spec.nchannels;
    int64_t at = (y / side * across + x / side) * size;
    auto* to = static_cast<char*>(data);
    for (int64_t left = size; left > 0;) {
      const ssize_t got = ::pread(descriptor_, to, static_cast<size_t>(left), at);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        errorfmt("cannot be read: {}", got < 0 ? std::strerror(errno) : "is truncated");
        return false;
      }
      left -= got;
      at += got;
      to += got;
    }
    return true;
  }

 private:
  int descriptor_ = -1;
};

struct DestroyCache {
  void operator()(OIIO::ImageCache* cache) const { OIIO::ImageCache::destroy(cache, true); }
};

}  // namespace

struct PelageTileImage {
  OIIO::ImageCache* cache;
  OIIO::ImageCache::ImageHandle* handle;
  int side;
  size_t texel_bytes;
  /// A tile could not be read. The cache stores such tiles, and returns an empty one when the same thread
  /// asks again.
  std::atomic<bool> broken{false};

  PelageTileImage(OIIO::ImageCache* c, OIIO::ImageCache::ImageHandle* h, const PelageTiles& tiles)
      : cache(c), handle(h), side(tiles.side), texel_bytes(static_cast<size_t>(tiles.texel_bytes)) {}
};

struct PelageTileCache {
  std::unique_ptr<OIIO::ImageCache, DestroyCache> cache;
  std::mutex mutex;  // guards the following
  std::vector<std::unique_ptr<PelageTileImage>> images;
};

PelageTileCache* pelage_tile_cache_create(int64_t bytes) {
  try {
    auto result = std::make_unique<PelageTileCache>();
    result->cache.reset(OIIO::ImageCache::create(false));
    const auto limit = static_cast<float>(std::max<int64_t>(bytes, PELAGE_SMALLEST_TILE_CACHE));
    result->cache->attribute("max_memory_MB", limit / (1 << 20));
    result->cache->attribute("forcefloat", 0);
    return result.release();
  } catch (...) {
    return nullptr;
  }
}

void pelage_tile_cache_destroy(PelageTileCache* cache) { delete cache; }

PelageTileImage* pelage_tile_cache_add(PelageTileCache* cache, const PelageTiles* tiles) {
  try {
    const std::lock_guard lock(cache->mutex);
    // The cache identifies files by name only; no file of this name is opened.
    const OIIO::ustring name("pelage tiles " + std::to_string(cache->images.size()));
    const OIIO::ImageSpec config = TileInput::configuration(*tiles);
    if (!cache->cache->add_file(name, TileInput::create, &config)) return nullptr;
    OIIO::ImageCache::ImageHandle* handle = cache->cache->get_image_handle(name);
    if (!handle || !cache->cache->good(handle)) return nullptr;
    cache->images.push_back(std::make_unique<PelageTileImage>(cache->cache.get(), handle, *tiles));
    return cache->images.back().get();
  } catch (...) {
    return nullptr;
  }
}

int pelage_tile_cache_read(PelageTileImage* image, int x, int y, int width, int height, void* to) {
  if (image->broken) return 1;
  try {
    OIIO::ImageCache& cache = *image->cache;
    OIIO::ImageCache::Perthread* thread = cache.get_perthread_info();
    const int side = image->side;
    const size_t texel = image->texel_bytes, row = static_cast<size_t>(width) * texel;
    for (int ty = y / side * side; ty < y + height; ty += side) {
      for (int tx = x / side * side; tx < x + width; tx += side) {
        OIIO::ImageCache::Tile* tile = cache.get_tile(image->handle, thread, 0, 0, tx, ty, 0);
        if (!tile) {
          image->broken = true;
          static_cast<void>(cache.geterror());
          return 1;
        }
        OIIO::TypeDesc format;
        const auto* pixels = static_cast<const char*>(cache.tile_pixels(tile, format));
        const int left = std::max(x, tx), right = std::min(x + width, tx + side);
        const int top = std::max(y, ty), bottom = std::min(y + height, ty + side);
        if (pixels) {
          for (int row_y = top; row_y < bottom; ++row_y) {
            const auto from = static_cast<size_t>((row_y - ty) * side + left - tx);
            std::memcpy(static_cast<char*>(to) + static_cast<size_t>(row_y - y) * row +
                            static_cast<size_t>(left - x) * texel,
                        pixels + from * texel, static_cast<size_t>(right - left) * texel);
          }
        }
        cache.release_tile(tile);
        if (!pixels) return 1;
      }
    }
    return 0;
  } catch (...) {
    return 1;
  }
}
