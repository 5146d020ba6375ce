// SPDX-License-Identifier: Apache-2.0
#include "image/texture_library.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <system_error>

#include <Imath/half.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory_budget.h"
#include "base/memory_sample.h"
#include "base/value_readers.h"
#include "image/exr_check.h"
#include "image/host_image.h"
#include "image/image_reader.h"
#include "image/plain_png.h"
#include "image/radiance_hdr.h"
#include "image/truncation.h"

namespace pelage {
namespace {

/// Throws Error (kInput) at the position in the scene that names the file. The message is the path, followed
/// by `reason`.
[[noreturn]] void fail_image(const AssetPath& asset, const std::string& reason) {
  throw Error(ErrorKind::kInput, asset.position, asset.path.string() + ": " + reason);
}

/// Throws Error (kInput) with a clear message for problems that image libraries report poorly: a file that is
/// missing, empty, truncated (PNG and JPEG), not a regular file or a git-lfs pointer, or damaged EXR headers.
void check_image_file(const AssetPath& asset) {
  if (const std::string problem = file_problem(asset.path); !problem.empty()) fail_image(asset, problem);
  std::ifstream stream(asset.path, std::ios::binary);
  std::string beginning(64, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  if (stream.gcount() == 0) fail_image(asset, stream.bad() || !stream.eof() ? "cannot be read" : "is empty");
  if (const std::string_view foreign = foreign_contents(beginning); !foreign.empty())
    fail_image(asset, std::string(foreign));
  if (is_cut_short(stream)) fail_image(asset, "is truncated");
  if (beginning.starts_with("v/1\x01")) {
    try {
      check_exr_headers(asset.path);
    } catch (const Error& damage) {
      fail_image(asset, damage.problems().front().message);
    }
  }
}

/// Fractions of the ledger's limit.
constexpr int64_t kInMemoryShare = 4, kTileCacheShare = 8;
/// Reading a larger image may take a second; shows progress.
constexpr int64_t kLargeImage = int64_t(16) << 20;
/// Up to this size, the claimed size of an image is reserved at once; larger ones grow as they are read.
constexpr size_t kReservedAtOnce = size_t(1) << 24;

/// Rethrows an error of the ledger or the disk at the place in the scene that names the file.
[[noreturn]] void rethrow_at(const AssetPath& asset, const Error& error) {
  const std::string& message = error.problems().front().message;
  const std::string file = asset.path.string();
  throw Error(error.kind(), asset.position, message.starts_with(file) ? message : file + ": " + message);
}

/// Extends `range` by the values of one channel of `count` texels starting at `values`. Returns the first
/// texel with a non-finite value, or `count`.
template <class Value, class IsFinite>
size_t scan_channel(const std::byte* values, size_t count, size_t step, TexelKind kind, IsFinite is_finite,
                    NumberRange& range) {
  const auto value = [&](size_t i) {
    Value v;
    std::memcpy(&v, values + i * step, sizeof v);
    return v;
  };
  Value low = value(0), high = low;
  for (size_t i = 0; i < count; ++i) {
    const Value v = value(i);
    if (!is_finite(v)) return i;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  range.first = std::min(range.first, stored_number(reinterpret_cast<const std::byte*>(&low), kind));
  range.second = std::max(range.second, stored_number(reinterpret_cast<const std::byte*>(&high), kind));
  return count;
}

/// Index of the first texel with a non-finite value, or `count`. Extends the ranges of the channels.
size_t scan(const std::byte* texels, size_t count, const TexelLayout& layout,
            std::vector<NumberRange>& ranges) {
  const size_t step = layout.texel_bytes();
  const auto always = [](auto) { return true; };
  size_t first = count;
  for (int c = 0; c < layout.channels; ++c) {
    const std::byte* values = texels + static_cast<size_t>(c) * value_bytes(layout.kind);
    NumberRange& range = ranges[static_cast<size_t>(c)];
    size_t good = count;
    if (layout.kind == TexelKind::kU8) {
      good = scan_channel<uint8_t>(values, count, step, layout.kind, always, range);
    } else if (layout.kind == TexelKind::kU16) {
      good = scan_channel<uint16_t>(values, count, step, layout.kind, always, range);
    } else if (layout.kind == TexelKind::kHalf) {
      good = scan_channel<Imath::half>(
          values, count, step, layout.kind, [](Imath::half v) { return v.isFinite(); }, range);
    } else {
      good = scan_channel<float>(
          values, count, step, layout.kind, [](float v) { return std::isfinite(v); }, range);
    }
    first = std::min(first, good);
  }
  return first;
}

}  // namespace

/// Receives one image: chooses its storage, checks its values, stores its rows.
class TextureLibrary::TextureSink final : public ImageSink {
 public:
  TextureSink(TextureLibrary& library, const AssetPath& asset) : library_(library), asset_(asset) {}
  ~TextureSink() override {
    if (is_shown_) library_.progress_->end();
  }

  void begin(const ImageHeader& header) override {
    header_ = header;
    const TexelLayout& layout = header_.layout;
    ranges_.assign(static_cast<size_t>(layout.channels), {HUGE_VALF, -HUGE_VALF});
    const auto bytes = static_cast<int64_t>(layout.bytes());
    int64_t working = header_.working_bytes;
    const MemoryLedger& ledger = library_.ledger_;
    const int64_t limit = ledger.limit();
    const bool in_share = limit == 0 || library_.in_memory_ + bytes <= limit / kInMemoryShare;
    const std::string size =
        fmt::format("the map {} ({} x {} texels)", asset_.path.string(), layout.width, layout.height);
    if (in_share && has_room(ledger, bytes + working)) {
      stored_.charge = reserve(library_.ledger_, MemoryTag::kTextures, bytes, size);
      texels_.reserve(std::min(layout.bytes(), kReservedAtOnce));
    } else {
      cache_ = library_.tile_cache();
      tiles_ = std::make_unique<TileFile>(layout);
      working += static_cast<int64_t>(TileFile::buffer_bytes(layout));
    }
    working_ = reserve(library_.ledger_, MemoryTag::kTextures, working, "reading " + size);
    is_shown_ = library_.progress_ && bytes >= kLargeImage;
    if (is_shown_) {
      library_.progress_->begin("read " + asset_.path.filename().string(), layout.height);
    }
  }

  void rows(const std::byte* rows, int count) override {
    library_.check_stop();
    const TexelLayout& layout = header_.layout;
    const auto width = static_cast<size_t>(layout.width);
    const size_t texels = static_cast<size_t>(count) * width;
    if (const size_t pixel = scan(rows, texels, layout, ranges_); pixel < texels) {
      fail_image(asset_, fmt::format("contains a non-finite value at pixel {}, {}", pixel % width,
                                     static_cast<size_t>(rows_) + pixel / width));
    }
    if (tiles_) {
      tiles_->add_rows(rows, count);
    } else {
      const size_t bytes = static_cast<size_t>(count) * layout.row_bytes();
      if (texels_.size() + bytes > texels_.capacity()) {
        texels_.reserve(std::min(layout.bytes(), std::max(texels_.size() + bytes, 2 * texels_.capacity())));
      }
      texels_.insert(texels_.end(), rows, rows + bytes);
    }
    rows_ += count;
    if (is_shown_) library_.progress_->advance(count);
  }

  Stored finish() {
    if (rows_ != header_.layout.height) fail_image(asset_, "is truncated");
    stored_.is_integer = header_.is_integer;
    if (tiles_) {
      stored_.texels = cache_->store(asset_.path.string(), header_.layout, ranges_, std::move(tiles_));
    } else {
      stored_.in_memory = static_cast<int64_t>(header_.layout.bytes());
      library_.in_memory_ += stored_.in_memory;
      stored_.texels = std::make_shared<TexelsInMemory>(header_.layout, ranges_, std::move(texels_));
    }
    return std::move(stored_);
  }

 private:
  TextureLibrary& library_;
  const AssetPath& asset_;
  ImageHeader header_;
  std::vector<NumberRange> ranges_;
  Stored stored_;
  MemoryCharge working_;
  std::shared_ptr<TileCache> cache_;
  std::unique_ptr<TileFile> tiles_;
  std::vector<std::byte> texels_;
  int rows_ = 0;
  bool is_shown_ = false;
};

TextureLibrary::TextureLibrary(MemoryLedger& ledger, Progress* progress)
    : ledger_(ledger), progress_(progress) {}
TextureLibrary::~TextureLibrary() = default;

void TextureLibrary::check_stop() const {
  if (progress_ && progress_->cancelled())
    throw Error(ErrorKind::kStopped, "stopped before the work was done");
}

const ImageReader& TextureLibrary::reader() {
  if (!reader_) {
    // Pages of the files themselves are shared and can be dropped, so they are not charged.
    const int64_t before = resident_memory().anonymous;
    reader_ = std::make_unique<ImageReader>();
    const int64_t cost = std::max<int64_t>(resident_memory().anonymous - before, 0);
    library_charge_ = MemoryCharge(ledger_, MemoryTag::kLibraries, cost);
  }
  return *reader_;
}

std::shared_ptr<TileCache> TextureLibrary::tile_cache() {
  if (!tiles_) {
    int64_t bytes = std::max(TileCache::kSmallest, ledger_.limit() / kTileCacheShare);
    if (!has_room(ledger_, bytes)) bytes = TileCache::kSmallest;
    MemoryCharge charge = reserve(ledger_, MemoryTag::kTextures, bytes, "the cache of texture tiles");
    tiles_ = std::make_shared<TileCache>(reader(), bytes);
    tiles_charge_ = std::move(charge);
  }
  return tiles_;
}

const TextureLibrary::Stored& TextureLibrary::stored(const AssetPath& asset,
                                                     const std::filesystem::path& path) {
  if (const auto found = stored_.find(path); found != stored_.end()) return found->second;
  if (asset.data) return shared(asset);
  check_image_file(asset);
  const FileStamp stamp = file_stamp(path);
  TextureSink intake(*this, asset);
  try {
    // Before the file is opened, because a progressive JPEG is decoded then.
    std::ifstream stream(asset.path, std::ios::binary);
    const MemoryCharge whole =
        reserve(ledger_, MemoryTag::kTextures, interlaced_bytes(stream),
                asset.path.string() + ": is progressive or interlaced, so it is decoded as a whole");
    std::optional<std::string> damage = read_plain_png(asset.path, intake);
    if (!damage) damage = read_radiance_hdr(asset.path, intake);
    if (!damage) damage = reader().read(asset.path, intake);
    if (!damage->empty()) fail_image(asset, *damage);
    Stored& read = stored_.emplace(path, intake.finish()).first->second;
    read.stamp = stamp;
    return read;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kMemory, asset.position, asset.path.string() + ": does not fit in memory");
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kInput || error.kind() == ErrorKind::kStopped) throw;
    rethrow_at(asset, error);
  }
}

const TextureLibrary::Stored& TextureLibrary::shared(const AssetPath& asset) {
  const auto* image = dynamic_cast<const HostImage*>(asset.data.get());
  if (!image) throw Error(ErrorKind::kInput, asset.position, "expected an image, got " + asset.path.string());
  TextureSink intake(*this, asset);
  try {
    image->read(intake);
    return stored_.emplace(asset.path, intake.finish()).first->second;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kInput || error.kind() == ErrorKind::kStopped) throw;
    rethrow_at(asset, error);
  }
}

template <class IsOld>
void TextureLibrary::forget(const IsOld& is_old) {
  for (auto image = stored_.begin(); image != stored_.end();) {
    const std::filesystem::path path = image->first;
    if (!is_old(path, image->second)) {
      ++image;
      continue;
    }
    entries_.erase({path, false});
    entries_.erase({path, true});
    in_memory_ -= image->second.in_memory;
    image = stored_.erase(image);
  }
}

void TextureLibrary::forget_changed() {
  const std::lock_guard lock(mutex_);
  forget([](const std::filesystem::path& path, const Stored& image) {
    return path.is_absolute() && image.stamp != file_stamp(path);  // images of a host never change
  });
}

void TextureLibrary::forget_unused() {
  const std::lock_guard lock(mutex_);
  std::set<std::filesystem::path> used;
  for (const auto& [key, entry] : entries_) {
    if (entry.texture.use_count() > 1) used.insert(key.first);
  }
  forget([&](const std::filesystem::path& path, const Stored&) { return !used.contains(path); });
}

std::shared_ptr<const Texture> TextureLibrary::load(const AssetPath& asset, ColorSpace space) {
  const std::filesystem::path path =
      asset.data ? asset.path : std::filesystem::absolute(asset.path).lexically_normal();
  const std::lock_guard lock(mutex_);
  const Stored& file = stored(asset, path);
  const bool srgb = space == ColorSpace::kSrgb || (space == ColorSpace::kAuto && file.is_integer);
  Entry& entry = entries_[{path, srgb}];
  if (!entry.texture) {
    auto texture = std::make_shared<const Texture>(file.texels, srgb);
    entry.charge = MemoryCharge(ledger_, MemoryTag::kTextures, static_cast<int64_t>(texture->bytes()));
    entry.texture = std::move(texture);
  }
  return entry.texture;
}

}  // namespace pelage
