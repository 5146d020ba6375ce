// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <type_traits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "base/check.h"
#include "base/error.h"
#include "base/file.h"
#include "image/exr_check.h"
#include "image/exr_header.h"
#include "image/exr_threads.h"

namespace pelage {
namespace {

/// Rows that are compressed together.
constexpr int kBlockRows = 16;

/// Rows that are written at a time: a block for each thread.
int rows_at_once(int threads) { return kBlockRows * std::max(1, threads); }

/// Pixels of one channel in the representation of the file: half channels are rounded here, once.
struct Storage {
  std::vector<half> halves;
  const void* base = nullptr;
  size_t size = 4;
};

Storage storage_for_writing(const ExrChannel& channel, size_t pixels) {
  const bool ids = channel.type == ChannelType::kUint;
  PELAGE_CHECK((ids ? channel.ids.size() : channel.pixels.size()) == pixels);
  Storage s;
  if (ids) {
    s.base = channel.ids.data();
  } else if (channel.type == ChannelType::kFloat) {
    s.base = channel.pixels.data();
  } else {
    s.halves.resize(pixels);
    std::transform(channel.pixels.begin(), channel.pixels.end(), s.halves.begin(), rounded_half);
    s.base = s.halves.data();
    s.size = sizeof(half);
  }
  return s;
}

void write_rows(Imf::OutputFile& file, int width, int y0, int y1, const std::vector<ExrChannel>& channels) {
  const Imath::Box2i window({0, y0}, {width - 1, y1 - 1});
  Imf::FrameBuffer frame;
  std::vector<Storage> storage;
  storage.reserve(channels.size());
  for (const ExrChannel& channel : channels) {
    storage.push_back(
        storage_for_writing(channel, static_cast<size_t>(width) * static_cast<size_t>(y1 - y0)));
    const Storage& s = storage.back();
    frame.insert(channel.name, Imf::Slice::Make(pixel_type(channel.type), s.base, window, s.size,
                                                s.size * static_cast<size_t>(width)));
  }
  file.setFrameBuffer(frame);
  file.writePixels(y1 - y0);
}

void write_file(const std::filesystem::path& path, int width, int height, const ExrAttributes& attributes,
                const ExrRowSource& rows, int threads) {
  const int step = rows_at_once(threads);
  std::vector<ExrChannel> channels = rows(0, std::min(height, step));
  PELAGE_CHECK(!channels.empty());
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.lineOrder() = Imf::INCREASING_Y;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709 is the library's default
  insert_attributes(header, attributes);
  for (const ExrChannel& channel : channels) {
    header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
  }
  Imf::OutputFile file(path.c_str(), header, exr_threads(threads));
  for (int y = 0; y < height; y += step) {
    const int end = std::min(y + step, height);
    if (y > 0) channels = rows(y, end);
    write_rows(file, width, y, end, channels);
  }
}

void read_header(const Imf::Header& header, const std::filesystem::path& path, ExrImage& image) {
  const Imath::Box2i window = header.dataWindow();
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
      refuse_exr(path, "channel '" + std::string(c.name()) + "' is subsampled, which is not supported");
    }
    image.channels.push_back({c.name(), channel_type(c.channel().type), {}, {}});
  }
  image.attributes = read_attributes(header);
}

/// Rows that are read at a time. Memory grows as they arrive: a header may claim rows that the file does not
/// hold.
constexpr int kStripRows = 256;

void read_rows(Imf::InputFile& file, ExrImage& image) {
  const Imath::Box2i window = file.header().dataWindow();
  const size_t row = static_cast<size_t>(image.width);
  for (int y = window.min.y; y <= window.max.y; y += kStripRows) {
    Imath::Box2i strip = window;
    strip.min.y = y;
    strip.max.y = std::min(y + kStripRows - 1, window.max.y);
    const size_t count = row * static_cast<size_t>(strip.max.y - strip.min.y + 1);
    Imf::FrameBuffer frame;
    for (ExrChannel& channel : image.channels) {
      const bool ids = channel.type == ChannelType::kUint;
      const size_t held = ids ? channel.ids.size() : channel.pixels.size();
      void* base = nullptr;
      if (ids) {
        channel.ids.resize(held + count);
        base = &channel.ids[held];
      } else {
        channel.pixels.resize(held + count);
        base = &channel.pixels[held];
      }
      frame.insert(channel.name, Imf::Slice::Make(ids ? Imf::UINT : Imf::FLOAT, base, strip, 4, 4 * row));
    }
    file.setFrameBuffer(frame);
    file.readPixels(strip.min.y, strip.max.y);
  }
}

}  // namespace

const ExrChannel* ExrImage::find(std::string_view name) const {
  for (const ExrChannel& channel : channels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

void write_exr(const std::filesystem::path& path, int width, int height, const ExrAttributes& attributes,
               const ExrRowSource& rows, int threads) {
  PELAGE_CHECK(width > 0 && height > 0);
  AtomicFile file(path);
  try {
    write_file(file.temporary_path(), width, height, attributes, rows, threads);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::kFailed, {path.string(), 0, 0}, std::string("cannot write: ") + error.what());
  }
  file.commit();
}

int64_t exr_writing_bytes(int width, const std::vector<ExrChannel>& channels, int threads) {
  int64_t made = 0, stored = 0;  // per pixel: by the source and what it is rounded to, and in the file
  for (const ExrChannel& channel : channels) {
    const int64_t size = channel.type == ChannelType::kHalf ? sizeof(half) : sizeof(float);
    made += sizeof(float) + (channel.type == ChannelType::kHalf ? size : 0);
    stored += size;
  }
  // The library has two blocks per thread under way, each as pixels, rearranged, and compressed.
  const int64_t blocks = std::max(1, 2 * exr_threads(threads));
  return width * (rows_at_once(threads) * made + blocks * kBlockRows * 3 * stored);
}

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  const auto rows = [&image](int y0, int y1) {
    const auto begin = static_cast<std::ptrdiff_t>(image.width) * y0;
    const auto end = static_cast<std::ptrdiff_t>(image.width) * y1;
    const auto part = [&](const auto& all) {
      return all.empty() ? all : std::decay_t<decltype(all)>(all.begin() + begin, all.begin() + end);
    };
    std::vector<ExrChannel> channels;
    for (const ExrChannel& channel : image.channels) {
      channels.push_back({channel.name, channel.type, part(channel.pixels), part(channel.ids)});
    }
    return channels;
  };
  const auto pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  for (const ExrChannel& channel : image.channels) {
    PELAGE_CHECK((channel.type == ChannelType::kUint ? channel.ids.size() : channel.pixels.size()) == pixels);
  }
  write_exr(path, image.width, image.height, image.attributes, rows, 1);
}

ExrImage read_exr(const std::filesystem::path& path) {
  check_exr_headers(path);
  ExrImage image;
  try {
    Imf::InputFile file(path.c_str(), 0);
    read_header(file.header(), path, image);
    read_rows(file, image);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kMemory, {path.string(), 0, 0}, "does not fit in memory");
  } catch (const std::exception& error) {
    refuse_exr(path, damage_text(error, path));
  }
  return image;
}

}  // namespace pelage
