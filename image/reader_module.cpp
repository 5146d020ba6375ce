// SPDX-License-Identifier: Apache-2.0
#include "image/reader_module.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace {

constexpr int kLargestSide = 1 << 16;
constexpr int kMaxChannels = 4;
constexpr size_t kStripValues = size_t(1) << 18;
constexpr size_t kMaxStripValues = size_t(1) << 26;

/// The library's messages may have several lines.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.' || text.back() == ' ')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "cannot be decoded" : text;
}

/// Once per process: no threads, which would compete with the renderer's; bounded memory; and only the format
/// that the name states (otherwise a damaged file is passed to readers of movies and camera raws, at 200 MB
/// each).
void configure() {
  static const bool done = [] {
    OIIO::attribute("exr_threads", 1);
    OIIO::attribute("limits:imagesize_MB", 4096);
    OIIO::attribute("try_all_readers", 0);
    return true;
  }();
  static_cast<void>(done);
}

int kind_of(OIIO::TypeDesc type) {
  if (type == OIIO::TypeDesc::UINT8) return PELAGE_TEXEL_U8;
  if (type == OIIO::TypeDesc::UINT16) return PELAGE_TEXEL_U16;
  return type == OIIO::TypeDesc::HALF ? PELAGE_TEXEL_HALF : PELAGE_TEXEL_FLOAT;
}

class Source {
 public:
  explicit Source(const char* path) {
    OIIO::ImageSpec configuration;
    configuration["oiio:UnassociatedAlpha"] = 1;
    input_ = OIIO::ImageInput::open(path, &configuration);
    if (!input_) throw std::runtime_error(one_line(OIIO::geterror()));
    // Setting this for the library as a whole would start the very threads that should be avoided.
    input_->threads(1);
  }

  PelageImageInfo info() const {
    const OIIO::ImageSpec& spec = input_->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
      throw std::runtime_error("is not an image");
    }
    if (spec.width > kLargestSide || spec.height > kLargestSide) {
      throw std::runtime_error("claims to have " + std::to_string(spec.width) + " x " +
                               std::to_string(spec.height) + " pixels; the limit is 65536 per side");
    }
    PelageImageInfo info{};
    info.width = spec.width;
    info.height = spec.height;
    info.channels = std::min(spec.nchannels, kMaxChannels);
    info.kind = kind_of(type());
    info.is_integer = spec.format.is_floating_point() ? 0 : 1;
    const auto strip = static_cast<int64_t>(strip_rows(info)) * info.width * info.channels;
    info.working_bytes = decoder_bytes() + strip * static_cast<int64_t>(type().size());
    return info;
  }

  /// Passes strips of rows to the sink; false when the sink stops.
  bool read(const PelageImageInfo& info, const PelageImageSink& sink) {
    const OIIO::ImageSpec& spec = input_->spec();
    const size_t row = static_cast<size_t>(info.width) * static_cast<size_t>(info.channels);
    const bool tiled = spec.tile_width > 0;
    const int rows = strip_rows(info);
    if (row * static_cast<size_t>(std::min(rows, info.height)) > kMaxStripValues) {
      throw std::runtime_error("has tiles that are too large");
    }
    const OIIO::TypeDesc values = type();
    // Rows that need no conversion are read without one: read_scanlines() allocates 16 MB for each strip.
    const bool as_stored = values == spec.format && spec.channelformats.empty();
    std::vector<char> strip;
    for (int y = 0; y < info.height; y += rows) {
      const int end = std::min(y + rows, info.height);
      strip.resize(row * static_cast<size_t>(end - y) * values.size());
      const int top = spec.y + y, bottom = spec.y + end;
      const bool good =
          tiled ? input_->read_tiles(0, 0, spec.x, spec.x + spec.width, top, bottom, spec.z, spec.z + 1, 0,
                                     info.channels, values, strip.data())
          : as_stored
              ? input_->read_native_scanlines(0, 0, top, bottom, spec.z, 0, info.channels, strip.data())
              : input_->read_scanlines(0, 0, top, bottom, spec.z, 0, info.channels, values, strip.data());
      if (!good) throw std::runtime_error(one_line(input_->geterror()));
      if (sink.rows(sink.context, strip.data(), end - y) != 0) return false;
    }
    return true;
  }

 private:
  /// The type of the passed values: the stored one if the C interface supports it.
  OIIO::TypeDesc type() const {
    const OIIO::ImageSpec& spec = input_->spec();
    const bool is_known = spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16 ||
                          spec.format == OIIO::TypeDesc::HALF;
    return is_known && spec.channelformats.empty() ? spec.format : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT);
  }

  bool is_format(std::string_view name) const { return input_->format_name() == name; }
  int exr_block_rows() const {
    return input_->spec().get_string_attribute("compression").substr(0, 4) == "dwab" ? 256 : 32;
  }

  int strip_rows(const PelageImageInfo& info) const {
    const size_t row = static_cast<size_t>(info.width) * static_cast<size_t>(info.channels);
    const OIIO::ImageSpec& spec = input_->spec();
    if (spec.tile_width > 0) return spec.tile_height;
    int rows = static_cast<int>(std::max<size_t>(kStripValues / row, 1));
    // OpenEXR decodes blocks of rows; a strip that ends within a block makes it decode the block again.
    if (is_format("openexr")) rows = (rows + exr_block_rows() - 1) / exr_block_rows() * exr_block_rows();
    return std::min(rows, info.height);
  }

  /// Memory that the library and its dependencies allocate while decoding. Few formats are read row by row.
  int64_t decoder_bytes() const {
    const OIIO::ImageSpec& spec = input_->spec();
    const auto row = static_cast<int64_t>(spec.scanline_bytes(true));
    int64_t rows = spec.height;
    if (spec.tile_width > 0) {
      rows = spec.tile_height;
    } else if (is_format("png") || is_format("jpeg") || is_format("hdr") || is_format("pnm")) {
      rows = 1;
    } else if (is_format("openexr")) {
      rows = 3 * exr_block_rows();
    } else if (is_format("tiff")) {
      rows = 2 * std::min(spec.get_int_attribute("tiff:RowsPerStrip", spec.height), spec.height);
    }
    return row * rows;
  }

  std::unique_ptr<OIIO::ImageInput> input_;
};

}  // namespace

int pelage_image_reader_version(void) {
  configure();
  return PELAGE_IMAGE_READER_VERSION;
}

int pelage_read_image(const char* path, const PelageImageSink* sink, char* message, size_t message_size) {
  try {
    configure();
    Source source(path);
    const PelageImageInfo info = source.info();
    if (sink->begin(sink->context, &info) != 0) return 1;
    return source.read(info, *sink) ? 0 : 1;
  } catch (const std::exception& error) {
    std::snprintf(message, message_size, "%s", error.what());
  } catch (...) {
    std::snprintf(message, message_size, "cannot be decoded");
  }
  return 1;
}
