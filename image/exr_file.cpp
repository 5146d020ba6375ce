// SPDX-License-Identifier: Apache-2.0
#include "image/exr_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>

#include "base/check.h"
#include "base/file.h"
#include "image/exr_check.h"
#include "image/exr_errors.h"
#include "image/exr_header.h"

namespace pelage {
namespace {

/// Lets OpenEXR write to an AtomicFile without an intermediate buffer. Also stores the exception of the first
/// failed write, because OpenEXR writes its table of rows in a destructor that swallows exceptions.
class ExrStream final : public Imf::OStream {
 public:
  explicit ExrStream(AtomicFile& file) : OStream(file.temporary_path().c_str()), file_(file) {}

  void write(const char bytes[], int count) override;
  uint64_t tellp() override { return place_; }
  void seekp(uint64_t place) override { place_ = place; }

  /// Throws the exception of the first failed write, if any.
  void check() const;

 private:
  AtomicFile& file_;
  uint64_t place_ = 0;
  std::exception_ptr failure_;
};

void ExrStream::write(const char bytes[], int count) {
  try {
    file_.write_at(place_, std::as_bytes(std::span(bytes, static_cast<size_t>(count))));
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
    throw;
  }
  place_ += static_cast<uint64_t>(count);
}

void ExrStream::check() const {
  if (failure_) std::rethrow_exception(failure_);
}

/// OpenEXR's own threads, one pool per process. None under the thread sanitizer, because they are not
/// instrumented.
int library_threads(int threads) {
#ifdef PELAGE_STD_THREADS
  threads = 0;
#endif
  threads = threads > 1 ? threads : 0;
  if (threads > Imf::globalThreadCount()) Imf::setGlobalThreadCount(threads);
  return threads;
}

PixelBox box_of(const Imath::Box2i& box) { return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1}; }
Imath::Box2i box_of(const PixelBox& box) { return {{box.x0, box.y0}, {box.x1 - 1, box.y1 - 1}}; }

ExrPart describe(const Imf::Header& header, const std::filesystem::path& path) {
  ExrPart part;
  if (header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE)) {
    refuse_exr(path, "holds deep pixels, which are not supported");
  }
  part.data = box_of(header.dataWindow());
  part.display = box_of(header.displayWindow());
  if (header.hasName()) part.name = header.name();
  if (header.hasView()) part.view = header.view();
  if (Imf::hasMultiView(header)) part.multi_view = Imf::multiView(header);
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
      refuse_exr(path, "channel '" + std::string(c.name()) + "' is subsampled, which is not supported");
    }
    part.channels.push_back({c.name(), channel_type(c.channel().type)});
  }
  part.attributes = read_attributes(header);
  return part;
}

/// Number of rows compressed together, by compression (none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA,
/// DWAB).
constexpr int kRowsPerBlock[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
/// A block is stored as in the file, as pixels, and once in between.
constexpr int64_t kCopiesOfBlock = 3;

/// Memory of the library while it reads or writes a part with `team` threads: two blocks of rows each.
int64_t bytes_of_blocks(const Imf::Header& header, const ExrPart& part, int team) {
  const auto compression = static_cast<size_t>(header.compression());
  int64_t rows = compression < std::size(kRowsPerBlock) ? kRowsPerBlock[compression] : 256;
  if (header.hasTileDescription()) rows = std::max<int64_t>(rows, header.tileDescription().ySize);
  int64_t pixel = 0;
  for (const ExrChannelInfo& channel : part.channels) pixel += channel.type == ChannelType::kHalf ? 2 : 4;
  return std::max(1, 2 * team) * kCopiesOfBlock * rows * pixel * part.data.width();
}

bool loses(Imf::Compression compression) {
  return compression != Imf::NO_COMPRESSION && compression != Imf::RLE_COMPRESSION &&
         compression != Imf::ZIPS_COMPRESSION && compression != Imf::ZIP_COMPRESSION &&
         compression != Imf::PIZ_COMPRESSION;
}

/// Attributes about the layout of pixels in the file, and those that would no longer be true.
constexpr const char* kOfTheFile[] = {"tiles",   "chunkCount", "maxSamplesPerPixel",
                                      "preview", "version",    "type"};

/// The library truncates names at their first zero byte and at its max length, and keeps one channel per
/// name.
void check_names(const std::vector<ExrChannelInfo>& channels) {
  std::set<std::string_view> names;
  for (const ExrChannelInfo& channel : channels) {
    const std::string& name = channel.name;
    const char* why = name.empty()                           ? "has no name"
                      : name.size() > kLongestExrName        ? "has a name of more than 255 bytes"
                      : name.find('\0') != std::string::npos ? "has a zero byte in its name"
                      : !names.insert(name).second           ? "occurs twice"
                                                             : nullptr;
    if (why) throw std::runtime_error("channel '" + std::string(name.c_str()) + "' " + why);
  }
}

Imf::Header header_for(const Imf::Header& like, const ExrPart& part) {
  check_names(part.channels);
  // Built from scratch rather than reduced: the library's erase() leaks what it erases.
  Imf::Header header;
  for (auto a = like.begin(); a != like.end(); ++a) {
    const std::string_view name = a.name();
    const bool is_dropped =
        std::find(std::begin(kOfTheFile), std::end(kOfTheFile), name) != std::end(kOfTheFile) ||
        (name == "multiView" && part.multi_view.empty());
    if (!is_dropped) header.insert(a.name(), a.attribute());
  }
  header.setType(Imf::SCANLINEIMAGE);
  header.lineOrder() = Imf::INCREASING_Y;
  if (loses(header.compression())) header.compression() = Imf::ZIP_COMPRESSION;
  if (!part.name.empty()) header.setName(part.name);
  if (!part.view.empty()) header.setView(part.view);
  header.dataWindow() = box_of(part.data);
  header.displayWindow() = box_of(part.display);
  header.channels() = Imf::ChannelList();
  for (const ExrChannelInfo& channel : part.channels) {
    header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
  }
  insert_attributes(header, part.attributes);
  return header;
}

}  // namespace

struct ExrReader::File {
  File(const char* path, int threads) : input(path, threads) {}
  Imf::MultiPartInputFile input;
};

ExrReader::ExrReader(std::filesystem::path path, int threads) : path_(std::move(path)) {
  check_exr_headers(path_);
  guarded_exr(path_, ErrorKind::kInput, [&] {
    const int team = library_threads(threads);
    file_ = std::make_unique<File>(path_.c_str(), team);
    for (int i = 0; i < file_->input.parts(); ++i) {
      parts_.push_back(describe(file_->input.header(i), path_));
      buffer_bytes_ += bytes_of_blocks(file_->input.header(i), parts_.back(), team);
    }
  });
  if (parts_.empty()) refuse_exr(path_, "has no parts");
}

ExrReader::~ExrReader() = default;

void ExrReader::read(size_t part, int y0, int y1, std::span<const ExrRows> rows) {
  const ExrPart& info = parts_.at(part);
  PELAGE_CHECK(y0 >= info.data.y0 && y1 <= info.data.y1 && y0 <= y1);
  if (y0 == y1 || rows.empty()) return;
  guarded_exr(path_, ErrorKind::kInput, [&] {
    Imf::FrameBuffer frame;
    for (const ExrRows& to : rows) {
      const ExrChannelInfo& channel = info.channels.at(to.channel);
      const Imath::Box2i where = box_of(PixelBox{info.data.x0, y0, info.data.x1, y1});
      frame.insert(channel.name, Imf::Slice::Make(channel.type == ChannelType::kUint ? Imf::UINT : Imf::FLOAT,
                                                  to.words, where, 4, 4 * to.row_stride));
    }
    Imf::InputPart input(file_->input, static_cast<int>(part));
    input.setFrameBuffer(frame);
    input.readPixels(y0, y1 - 1);
  });
}

struct ExrWriter::File {
  File(const std::filesystem::path& path, const std::vector<Imf::Header>& headers,
       std::vector<ExrPart> described, int team)
      : atomic(path),
        stream(atomic),
        output(std::make_unique<Imf::MultiPartOutputFile>(stream, headers.data(),
                                                          static_cast<int>(headers.size()), false, team)),
        parts(std::move(described)) {
    for (size_t i = 0; i < parts.size(); ++i) buffer_bytes += bytes_of_blocks(headers[i], parts[i], team);
  }
  AtomicFile atomic;
  ExrStream stream;
  std::unique_ptr<Imf::MultiPartOutputFile> output;
  std::vector<ExrPart> parts;
  std::vector<half> halves;  // one call's half channels, one after the other
  int64_t buffer_bytes = 0;
};

ExrWriter::ExrWriter(std::filesystem::path path, ExrPart part, int threads) : path_(std::move(path)) {
  PELAGE_CHECK(part.data.width() > 0 && part.data.height() > 0 && !part.channels.empty());
  file_ = guarded_exr(path_, ErrorKind::kFailed, [&] {
    Imf::Header own;
    own.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(own, Imf::Chromaticities());  // Rec. 709 is the library's default
    const std::vector headers{header_for(own, part)};
    return std::make_unique<File>(path_, headers, std::vector{std::move(part)}, library_threads(threads));
  });
}

ExrWriter::ExrWriter(std::filesystem::path path, const ExrReader& source, std::vector<ExrOutputPart> parts,
                     int threads)
    : path_(std::move(path)) {
  PELAGE_CHECK(!parts.empty());
  file_ = guarded_exr(path_, ErrorKind::kFailed, [&] {
    std::vector<Imf::Header> headers;
    std::vector<ExrPart> described;
    for (ExrOutputPart& part : parts) {
      headers.push_back(header_for(source.file_->input.header(static_cast<int>(part.like)), part.header));
      described.push_back(std::move(part.header));
    }
    return std::make_unique<File>(path_, headers, std::move(described), library_threads(threads));
  });
}

int64_t exr_buffer_bytes(const ExrPart& part, int threads) {
  Imf::Header header;
  header.compression() = Imf::ZIP_COMPRESSION;
  return bytes_of_blocks(header, part, library_threads(threads));
}

int64_t ExrWriter::buffer_bytes() const { return file_->buffer_bytes; }

ExrWriter::~ExrWriter() = default;

void ExrWriter::write(size_t part, int count, std::span<const ExrRows> rows, const Workers& workers) {
  if (count == 0) return;
  const ExrPart& info = file_->parts.at(part);
  PELAGE_CHECK(rows.size() == info.channels.size());
  const auto width = static_cast<size_t>(info.data.width()), height = static_cast<size_t>(count);
  size_t half_channels = 0;
  for (const ExrChannelInfo& channel : info.channels) half_channels += channel.type == ChannelType::kHalf;
  guarded_exr(path_, ErrorKind::kFailed, [&] {
    file_->halves.resize(half_channels * width * height);
    half* next = file_->halves.data();
    std::vector<std::pair<const ExrRows*, half*>> rounded;
    Imf::OutputPart output(*file_->output, static_cast<int>(part));
    const int y0 = output.currentScanLine();
    const Imath::Box2i where = box_of(PixelBox{info.data.x0, y0, info.data.x1, y0 + count});
    Imf::FrameBuffer frame;
    for (const ExrRows& from : rows) {
      const ExrChannelInfo& channel = info.channels.at(from.channel);
      const Imf::PixelType type = pixel_type(channel.type);
      if (channel.type == ChannelType::kHalf) {
        rounded.emplace_back(&from, next);
        frame.insert(channel.name, Imf::Slice::Make(type, next, where, sizeof(half), sizeof(half) * width));
        next += width * height;
      } else {
        frame.insert(channel.name, Imf::Slice::Make(type, from.words, where, 4, 4 * from.row_stride));
      }
    }
    workers.for_each(rounded.size(), 1, [&](WorkRange range) {
      const auto& [from, to] = rounded[range.begin];
      for (size_t y = 0; y < height; ++y) {
        const float* row = from->words + y * from->row_stride;
        std::transform(row, row + width, to + y * width, rounded_half);
      }
    });
    output.setFrameBuffer(frame);
    output.writePixels(count);
  });
}

void ExrWriter::commit() {
  guarded_exr(path_, ErrorKind::kFailed, [&] {
    for (size_t i = 0; i < file_->parts.size(); ++i) {
      Imf::OutputPart output(*file_->output, static_cast<int>(i));
      PELAGE_CHECK(output.currentScanLine() == file_->parts[i].data.y1);
    }
    file_->output.reset();
    file_->stream.check();
  });
  file_->atomic.commit();
}

}  // namespace pelage
