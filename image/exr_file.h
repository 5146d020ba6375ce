// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "image/exr.h"

namespace pelage {

/// Pixels x0 <= x < x1, y0 <= y < y1, in the pixel space of a file: x right, y down.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool operator==(const PixelBox&) const = default;
};

/// Max length of the name of a channel or attribute, in bytes.
inline constexpr size_t kLongestExrName = 255;

struct ExrChannelInfo {
  std::string name;
  ChannelType type = ChannelType::kHalf;
  bool operator==(const ExrChannelInfo&) const = default;
};

/// Contents of a part's header. A single part may have no name.
struct ExrPart {
  std::string name;
  std::string view;
  PixelBox data;     ///< where pixels exist
  PixelBox display;  ///< the frame of the picture
  std::vector<ExrChannelInfo> channels;
  ExrAttributes attributes;             ///< those that ExrAttribute can hold
  std::vector<std::string> multi_view;  ///< views of a multi-view part, the default first
};

/// Location of one channel's rows: each pixel is a 4-byte word, a float or, for kUint, the bits of the
/// integer. `words`: the first pixel of the first row to be transferred.
struct ExrRows {
  size_t channel = 0;
  float* words = nullptr;
  size_t row_stride = 0;  ///< in words
};

/// Reads any EXR of flat parts (scan lines or tiles, full resolution) by rows. Thread safety: one thread at a
/// time.
class ExrReader {
 public:
  /// Throws Error (kInput) naming the file when it is missing, damaged, deep or subsampled. `threads`: number
  /// of decoding threads.
  explicit ExrReader(std::filesystem::path path, int threads = 0);
  ~ExrReader();
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::vector<ExrPart>& parts() const { return parts_; }

  /// Max memory of the library while it decodes with these threads, or encodes the same data: blocks of rows,
  /// several per thread.
  int64_t buffer_bytes() const { return buffer_bytes_; }

  /// Reads rows y0 <= y < y1 of a part, which must lie in its data window; `rows` start at column data.x0.
  /// Throws Error (kInput) for a damaged file.
  void read(size_t part, int y0, int y1, std::span<const ExrRows> rows);

 private:
  friend class ExrWriter;
  struct File;
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
  std::vector<ExrPart> parts_;
  int64_t buffer_bytes_ = 0;
};

/// A part to write. Its header is a copy of the header of part `like` of the input file, including attributes
/// that Pelage does not know. `header` replaces the name, the view, the data window and the channels, and
/// adds its attributes.
struct ExrOutputPart {
  size_t like = 0;
  ExrPart header;
};

/// Writes a file by rows from the top, completely or not at all (law 6). Half channels are rounded to
/// nearest; values beyond their range become the largest finite half, infinity stays. `threads`: number of
/// encoding threads. Throws Error (kFailed) naming the path, also for channel names that a file cannot
/// distinguish. Thread safety: one thread at a time.
class ExrWriter {
 public:
  /// A new picture, ZIP compressed, with Rec. 709 chromaticities.
  ExrWriter(std::filesystem::path path, ExrPart part, int threads = 0);
  /// Parts with the headers of another file's parts. Keeps lossless compression; replaces lossy compression
  /// by ZIP.
  ExrWriter(std::filesystem::path path, const ExrReader& source, std::vector<ExrOutputPart> parts,
            int threads = 0);
  ~ExrWriter();
  ExrWriter(const ExrWriter&) = delete;
  ExrWriter& operator=(const ExrWriter&) = delete;

  /// Max memory of the library while it encodes.
  int64_t buffer_bytes() const;

  /// Writes the next `count` rows of a part, all its channels in order. `workers` convert floats to halves.
  void write(size_t part, int count, std::span<const ExrRows> rows, const Workers& workers);
  /// Finishes the file, once every part has all its rows, and moves it to its path.
  void commit();

 private:
  struct File;
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
};

}  // namespace pelage
