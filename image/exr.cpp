// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <algorithm>
#include <exception>
#include <new>

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

namespace pelage {
namespace {

/// Pixels of one channel in the representation of the file: half channels are rounded here, once.
struct Storage {
  std::vector<half> halves;
  char* base = nullptr;
  size_t size = 4;
};

Storage storage_for_writing(const ExrChannel& channel) {
  Storage s;
  if (channel.type == ChannelType::kUint) {
    s.base = reinterpret_cast<char*>(const_cast<uint32_t*>(channel.ids.data()));
  } else if (channel.type == ChannelType::kFloat) {
    s.base = reinterpret_cast<char*>(const_cast<float*>(channel.pixels.data()));
  } else {
    s.halves.resize(channel.pixels.size());
    std::transform(channel.pixels.begin(), channel.pixels.end(), s.halves.begin(), rounded_half);
    s.base = reinterpret_cast<char*>(s.halves.data());
    s.size = sizeof(half);
  }
  return s;
}

void write_file(const std::filesystem::path& path, const ExrImage& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.lineOrder() = Imf::INCREASING_Y;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709 is the library's default
  insert_attributes(header, image.attributes);
  Imf::FrameBuffer frame;
  std::vector<Storage> storage;
  storage.reserve(image.channels.size());
  for (const ExrChannel& channel : image.channels) {
    storage.push_back(storage_for_writing(channel));
    const Storage& s = storage.back();
    header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
    frame.insert(channel.name, Imf::Slice(pixel_type(channel.type), s.base, s.size,
                                          s.size * static_cast<size_t>(image.width)));
  }
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(frame);
  file.writePixels(image.height);
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

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  PELAGE_CHECK(image.width > 0 && image.height > 0 && !image.channels.empty());
  for (const ExrChannel& channel : image.channels) {
    const size_t held = channel.type == ChannelType::kUint ? channel.ids.size() : channel.pixels.size();
    PELAGE_CHECK(held == pixels);
  }
  AtomicFile file(path);
  try {
    write_file(file.temporary_path(), image);
  } catch (const std::exception& error) {
    throw Error(ErrorKind::kFailed, {path.string(), 0, 0}, std::string("cannot write: ") + error.what());
  }
  file.commit();
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
