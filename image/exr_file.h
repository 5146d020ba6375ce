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

/// Bytes in the name of a channel or attribute, at most.
inline constexpr size_t kLongestExrName = 255;

struct ExrChannelInfo {
  std::string name;
  ChannelType type = ChannelType::kHalf;
  bool operator==(const ExrChannelInfo&) const = default;
};

/// What the header of one part says. A file of one part may have no name.
struct ExrPart {
  std::string name;
  std::string view;
  PixelBox data;     ///< where pixels are given
  PixelBox display;  ///< the frame of the picture
  std::vector<ExrChannelInfo> channels;
  ExrAttributes attributes;             ///< those that ExrAttribute can hold
  std::vector<std::string> multi_view;  ///< views of a part that holds several, the default first
};

/// Where rows of one channel are: each pixel is a word of 4 bytes, a float or, in a channel of kUint, the
/// bits of the number. `words` is the first pixel of the first row that is moved.
struct ExrRows {
  size_t channel = 0;
  float* words = nullptr;
  size_t row_stride = 0;  ///< in words
};

/// Reads any EXR of flat parts (scan lines or tiles, full resolution) by rows. Thread safety: one thread at a
/// time.
class ExrReader {
 public:
  /// Throws Error (kInput) naming the file when it is missing, damaged, deep or subsampled. `threads`: how
  /// many may decode.
  explicit ExrReader(std::filesystem::path path, int threads = 0);
  ~ExrReader();
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::vector<ExrPart>& parts() const { return parts_; }

  /// What the library holds, at most, while it decodes with these threads, or encodes the same again: blocks
  /// of rows, several for each thread.
  int64_t buffer_bytes() const { return buffer_bytes_; }

  /// Rows y0 <= y < y1 of a part, which must lie in its data window; `rows` begin at column data.x0. Throws
  /// Error (kInput) where the file is damaged.
  void read(size_t part, int y0, int y1, std::span<const ExrRows> rows);

 private:
  friend class ExrWriter;
  struct File;
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
  std::vector<ExrPart> parts_;
  int64_t buffer_bytes_ = 0;
};

/// A part to write: everything in the header of part `like` of the file that was read, known to us or not,
/// but with this name, view, data window, channels and, beside its own, these attributes.
struct ExrOutputPart {
  size_t like = 0;
  ExrPart header;
};

/// Writes a file by rows from the top, whole or not at all (law 6). Half channels are rounded to nearest;
/// what is beyond their range becomes their largest number, infinity stays. `threads`: how many may encode.
/// Throws Error (kFailed) naming the path, also for channels whose names a file cannot hold apart. Thread
/// safety: one thread at a time.
class ExrWriter {
 public:
  /// A new picture, ZIP compressed, with Rec. 709 chromaticities.
  ExrWriter(std::filesystem::path path, ExrPart part, int threads = 0);
  /// Parts like those of another file. Compression is kept where it is lossless, and is ZIP where it was not.
  ExrWriter(std::filesystem::path path, const ExrReader& source, std::vector<ExrOutputPart> parts,
            int threads = 0);
  ~ExrWriter();
  ExrWriter(const ExrWriter&) = delete;
  ExrWriter& operator=(const ExrWriter&) = delete;

  /// What the library holds, at most, while it encodes.
  int64_t buffer_bytes() const;

  /// The next `count` rows of a part, all its channels in order. `workers` round floats to halves.
  void write(size_t part, int count, std::span<const ExrRows> rows, const Workers& workers);
  /// Ends the file, once every part has all its rows, and puts it where it belongs.
  void commit();

 private:
  struct File;
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
};

}  // namespace pelage
