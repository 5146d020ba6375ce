// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "image/exr.h"

namespace pelage {

/// Max length of the name of a channel or attribute, in bytes.
inline constexpr size_t kLongestExrName = 255;

struct ExrChannelInfo {
  std::string name;
  ChannelType type = ChannelType::kHalf;
  bool operator==(const ExrChannelInfo&) const = default;
};

/// Contents of the header of one part. If a file has only one part, its name may be empty.
struct ExrPart {
  std::string name;
  std::string view;
  PixelBox data;     ///< data window: the pixels that the part stores
  PixelBox display;  ///< display window: the frame of the picture
  std::vector<ExrChannelInfo> channels;
  ExrAttributes attributes;             ///< only attributes that ExrAttribute can hold
  std::vector<std::string> multi_view;  ///< views of a multi-view part, the default view first
};

/// Rows of one channel in memory, as source or destination of a transfer. Each pixel is a word of 4 bytes: a
/// float or, for kUint, the bits of the integer. `channel` is an index of ExrPart::channels. `words` points
/// to the first pixel of the first row.
struct ExrRows {
  size_t channel = 0;
  float* words = nullptr;
  size_t row_stride = 0;  ///< in words
};

/// Reads EXR files by rows. The parts must be flat (not deep); they may have scan lines or tiles. Of tiled
/// parts, reads the full resolution. Thread safety: only one thread at a time may use a reader.
class ExrReader {
 public:
  /// Reads the headers. Throws Error (kInput) naming the file when it is missing, damaged, deep or
  /// subsampled. `threads`: number of decoding threads; 0 or 1 decodes on the calling thread.
  explicit ExrReader(std::filesystem::path path, int threads = 0);
  ~ExrReader();
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::vector<ExrPart>& parts() const { return parts_; }

  /// Max memory in bytes that OpenEXR uses while it decodes the file with these threads: several blocks of
  /// rows per thread. Encoding the same data takes as much.
  int64_t buffer_bytes() const { return buffer_bytes_; }

  /// Reads rows y0 <= y < y1 of a part into `rows`, one entry per channel to read. The rows must lie in the
  /// data window. ExrRows::words receives the pixel in column data.x0 of row y0. Throws Error (kInput) for a
  /// damaged file.
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
/// that Pelage does not know. The data window, display window and channels of `header` replace those of the
/// copy. So do its name and view, unless they are empty. Its attributes are added, or replace those of the
/// same name.
struct ExrOutputPart {
  size_t like = 0;
  ExrPart header;
};

/// Writes a file by rows from the top. The file appears completely or not at all (law 6). Values of half
/// channels are rounded to nearest; finite values beyond the range of a half become the largest finite half,
/// and infinity stays infinite. All members throw Error (kFailed) naming the path. The constructors also
/// throw it when a channel name is empty, longer than kLongestExrName, contains a zero byte or occurs twice.
/// `threads`: number of encoding threads; 0 or 1 encodes on the calling thread. Thread safety: only one
/// thread at a time may use a writer.
class ExrWriter {
 public:
  /// Begins a picture with one part, ZIP compression and Rec. 709 chromaticities.
  ExrWriter(std::filesystem::path path, ExrPart part, int threads = 0);
  /// Begins a file whose parts have copies of the headers of `source`. Keeps the compression if it is
  /// lossless, else uses ZIP.
  ExrWriter(std::filesystem::path path, const ExrReader& source, std::vector<ExrOutputPart> parts,
            int threads = 0);
  ~ExrWriter();
  ExrWriter(const ExrWriter&) = delete;
  ExrWriter& operator=(const ExrWriter&) = delete;

  /// Max memory in bytes that OpenEXR uses while it encodes.
  int64_t buffer_bytes() const;

  /// Writes the next `count` rows of a part. `rows` has one entry for each channel of the part. `workers`
  /// convert floats to halves.
  void write(size_t part, int count, std::span<const ExrRows> rows, const Workers& workers);
  /// Finishes the file and moves it to its path. All rows of all parts must have been written.
  void commit();

 private:
  struct File;
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
};

/// Returns the memory that write_exr() takes for these channels, in bytes: what it charges to the ledger.
/// `width` and `height`: of the data window. `threads`: thread count of the workers.
int64_t exr_writing_bytes(const std::vector<ExrChannel>& channels, int width, int height, int threads);

/// Returns ExrWriter::buffer_bytes() of a writer of this picture, without making a file.
int64_t exr_buffer_bytes(const ExrPart& part, int threads);

}  // namespace pelage
