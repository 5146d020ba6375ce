// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>

#include "base/check.h"
#include "base/ledger.h"
#include "base/parallel.h"
#include "image/exr_check.h"
#include "image/exr_errors.h"
#include "image/exr_file.h"
#include "image/exr_header.h"

namespace pelage {
namespace {

/// Number of rows per thread that are made and written at once: as many as are compressed together.
constexpr int kRowsPerThread = 16;

std::vector<ExrChannelInfo> described(const std::vector<ExrChannel>& channels) {
  std::vector<ExrChannelInfo> result;
  for (const ExrChannel& channel : channels) result.push_back({channel.name, channel.type});
  return result;
}

/// Memory of one pixel as provided by a row source, and rounded.
int64_t bytes_of_pixel(const std::vector<ExrChannel>& channels) {
  int64_t bytes = 0;
  for (const ExrChannel& channel : channels)
    bytes += sizeof(float) + (channel.type == ChannelType::kHalf ? sizeof(half) : 0);
  return bytes;
}

/// Memory of the rows that are made and written at once.
int64_t bytes_of_rows(const std::vector<ExrChannel>& channels, int width, int height, int threads) {
  return bytes_of_pixel(channels) * width * std::min(kRowsPerThread * threads, height);
}

/// Locations of all channels' rows, for the writer.
std::vector<ExrRows> rows_of(std::vector<ExrChannel>& channels, size_t width, size_t count) {
  std::vector<ExrRows> rows;
  for (size_t i = 0; i < channels.size(); ++i) {
    ExrChannel& channel = channels[i];
    const bool ids = channel.type == ChannelType::kUint;
    PELAGE_CHECK((ids ? channel.ids.size() : channel.pixels.size()) == width * count);
    rows.push_back({i, ids ? reinterpret_cast<float*>(channel.ids.data()) : channel.pixels.data(), width});
  }
  return rows;
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

/// Number of rows read at once. Memory grows as they are read, because a header may claim rows that the file
/// does not contain.
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

void write_exr(const std::filesystem::path& path, const PixelBox& data, const PixelBox& display,
               const ExrAttributes& attributes, const ExrRowSource& rows, const Workers& workers,
               MemoryLedger& ledger) {
  const int width = data.width(), height = data.height();
  const int threads = workers.thread_count(), step = kRowsPerThread * threads;
  std::vector<ExrChannel> channels = rows(0, 0);
  ExrWriter writer(path, {{}, {}, data, display, described(channels), attributes, {}}, threads);
  const MemoryCharge charge(ledger, MemoryTag::kFilm,
                            writer.buffer_bytes() + bytes_of_rows(channels, width, height, threads));
  for (int y = 0; y < height; y += step) {
    const int count = std::min(step, height - y);
    channels = rows(y, y + count);
    writer.write(0, count, rows_of(channels, static_cast<size_t>(width), static_cast<size_t>(count)),
                 workers);
  }
  writer.commit();
}

int64_t exr_writing_bytes(const std::vector<ExrChannel>& channels, int width, int height, int threads) {
  return exr_buffer_bytes({{}, {}, {0, 0, width, height}, {0, 0, width, height}, described(channels), {}, {}},
                          threads) +
         bytes_of_rows(channels, width, height, threads);
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
  MemoryLedger none;  // the picture is already in memory
  const PixelBox frame{0, 0, image.width, image.height};
  write_exr(path, frame, frame, image.attributes, rows, Workers::alone(), none);
}

ExrImage read_exr(const std::filesystem::path& path) {
  check_exr_headers(path);
  ExrImage image;
  guarded_exr(path, ErrorKind::kInput, [&] {
    Imf::InputFile file(path.c_str(), 0);
    read_header(file.header(), path, image);
    read_rows(file, image);
  });
  return image;
}

}  // namespace pelage
