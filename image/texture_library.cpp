// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "base/file.h"
#include "base/memory_sample.h"
#include "base/module.h"
#include "image/exr_check.h"
#include "image/reader_module.h"
#include "image/texture.h"
#include "image/truncation.h"

namespace pelage {
namespace {

float from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

/// All but the alpha of grey + alpha and of RGBA.
void decode_srgb(Image& image) {
  const int colors = image.channels == 2 || image.channels == 4 ? image.channels - 1 : image.channels;
  for (size_t i = 0; i < image.pixels.size(); i += static_cast<size_t>(image.channels)) {
    for (int c = 0; c < colors; ++c) {
      float& v = image.pixels[i + static_cast<size_t>(c)];
      v = from_srgb(v);
    }
  }
}

[[noreturn]] void fail(const AssetPath& asset, const std::string& reason) {
  throw Error(ErrorKind::kInput, asset.position, asset.path.string() + ": " + reason);
}

/// What no image library says clearly.
void check_is_readable(const AssetPath& asset) {
  std::error_code error;
  const auto status = std::filesystem::status(asset.path, error);
  if (!std::filesystem::exists(status)) fail(asset, "there is no such file");
  if (!std::filesystem::is_regular_file(status)) fail(asset, "is not a regular file");
  std::ifstream stream(asset.path, std::ios::binary);
  std::string beginning(64, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  if (stream.gcount() == 0) fail(asset, stream.bad() || !stream.eof() ? "cannot be read" : "is empty");
  if (beginning.starts_with("version https://git-lfs"))
    fail(asset, "is a git-lfs pointer, not the image itself");
  const bool ends_with_marker = beginning.starts_with("\x89PNG") || beginning.starts_with("\xff\xd8\xff");
  if (ends_with_marker && is_cut_short(read_file(asset.path))) fail(asset, "is cut short");
  if (beginning.starts_with("v/1\x01")) {
    try {
      check_exr_headers(asset.path);
    } catch (const Error& damage) {
      fail(asset, damage.problems().front().message);
    }
  }
}

/// An image on its way out of the module. Grows as rows arrive, so that a damaged file costs what it holds,
/// not what it claims to hold.
struct Decoded {
  Image image;
  bool is_integer = false;
  bool out_of_memory = false;

  static int begin(void* context, const PelageImageInfo* info) {
    Decoded& d = *static_cast<Decoded*>(context);
    d.image.width = info->width;
    d.image.height = info->height;
    d.image.channels = info->channels;
    d.is_integer = info->is_integer != 0;
    return 0;
  }
  static int rows(void* context, const float* pixels, size_t count) {
    Decoded& d = *static_cast<Decoded*>(context);
    std::vector<float>& all = d.image.pixels;
    const size_t total = static_cast<size_t>(d.image.width) * static_cast<size_t>(d.image.height) *
                         static_cast<size_t>(d.image.channels);
    try {
      if (all.size() + count > all.capacity()) {
        all.reserve(std::min(total, std::max(all.size() + count, 2 * all.capacity())));
      }
      all.insert(all.end(), pixels, pixels + count);
    } catch (const std::bad_alloc&) {
      d.out_of_memory = true;
      return 1;
    }
    return 0;
  }
};

Decoded read_image(decltype(&pelage_read_image) read, const AssetPath& asset) {
  Decoded decoded;
  const PelageImageSink sink{&decoded, Decoded::begin, Decoded::rows};
  char message[512] = "";
  if (read(asset.path.c_str(), &sink, message, sizeof message) != 0) {
    if (decoded.out_of_memory) {
      throw Error(ErrorKind::kMemory, asset.position, asset.path.string() + ": does not fit in memory");
    }
    fail(asset, message);
  }
  return decoded;
}

void check_is_finite(const AssetPath& asset, const Image& image) {
  const auto bad =
      std::find_if(image.pixels.begin(), image.pixels.end(), [](float v) { return !std::isfinite(v); });
  if (bad == image.pixels.end()) return;
  const size_t pixel = static_cast<size_t>(bad - image.pixels.begin()) / static_cast<size_t>(image.channels);
  const size_t width = static_cast<size_t>(image.width);
  fail(asset, "holds a value that is not finite at pixel " + std::to_string(pixel % width) + ", " +
                  std::to_string(pixel / width));
}

}  // namespace

struct TextureLibrary::Reader {
  Reader() : module("pelage_image_reader") {
    using Version = decltype(&pelage_image_reader_version);
    const int version = reinterpret_cast<Version>(module.symbol("pelage_image_reader_version"))();
    if (version != PELAGE_IMAGE_READER_VERSION) {
      throw Error(ErrorKind::kFailed, "module pelage_image_reader is of another version of Pelage");
    }
    read = reinterpret_cast<decltype(read)>(module.symbol("pelage_read_image"));
  }

  Module module;
  decltype(&pelage_read_image) read = nullptr;
};

TextureLibrary::TextureLibrary(MemoryLedger& ledger) : ledger_(ledger) {}
TextureLibrary::~TextureLibrary() = default;

std::shared_ptr<const Texture> TextureLibrary::load(const AssetPath& asset, ColorSpace space) {
  const std::filesystem::path path = std::filesystem::absolute(asset.path).lexically_normal();
  const std::lock_guard lock(mutex_);
  if (const auto found = entries_.find({path, space}); found != entries_.end()) return found->second.texture;
  check_is_readable(asset);
  if (!reader_) {
    // Pages of the files themselves are shared and can be dropped: no ledger counts them.
    const int64_t before = resident_memory().anonymous;
    reader_ = std::make_unique<Reader>();
    const int64_t cost = std::max<int64_t>(resident_memory().anonymous - before, 0);
    library_charge_ = MemoryCharge(ledger_, MemoryTag::kLibraries, cost);
  }

  Decoded decoded = read_image(reader_->read, asset);
  check_is_finite(asset, decoded.image);
  const bool decode = space == ColorSpace::kSrgb || (space == ColorSpace::kAuto && decoded.is_integer);
  if (decode) decode_srgb(decoded.image);

  // `auto` is one of the other two, and shares its copy.
  Entry entry;
  const ColorSpace stored_as = decode ? ColorSpace::kSrgb : ColorSpace::kLinear;
  if (const auto same = entries_.find({path, stored_as}); same != entries_.end()) {
    entry.texture = same->second.texture;
  } else {
    entry.texture = std::make_shared<const Texture>(std::move(decoded.image));
    const size_t bytes = entry.texture->image().bytes();
    entry.charge = MemoryCharge(ledger_, MemoryTag::kTextures, static_cast<int64_t>(bytes));
  }
  const std::shared_ptr<const Texture> texture = entry.texture;
  if (space == ColorSpace::kAuto) entries_.try_emplace({path, stored_as}, Entry{texture, {}});
  entries_.emplace(std::pair(path, space), std::move(entry));
  return texture;
}

}  // namespace pelage
