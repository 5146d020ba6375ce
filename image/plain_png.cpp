// SPDX-License-Identifier: Apache-2.0
#include "image/plain_png.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <zlib.h>

namespace pelage {
namespace {

using namespace std::string_view_literals;

constexpr size_t kInput = size_t(1) << 16;
constexpr size_t kStripValues = size_t(1) << 18;
constexpr uint32_t kLargestSide = 1 << 16;
constexpr int64_t kInflateBytes = int64_t(48) << 10;  // state and window of zlib

/// What is wrong with the file.
struct Damage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

uint32_t big_endian(const unsigned char* bytes) {
  return uint32_t(bytes[0]) << 24 | uint32_t(bytes[1]) << 16 | uint32_t(bytes[2]) << 8 | bytes[3];
}

/// The chunks of a PNG file: length, type, data, checksum.
class Chunks {
 public:
  explicit Chunks(const std::filesystem::path& file) : file_(file, std::ios::binary) {}

  bool read(unsigned char* to, size_t bytes) {
    file_.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(bytes));
    return static_cast<size_t>(file_.gcount()) == bytes;
  }
  /// Reads the header of the next chunk.
  bool next() {
    std::array<unsigned char, 8> head{};
    if (!read(head.data(), head.size())) return false;
    left_ = big_endian(head.data());
    type_.assign(reinterpret_cast<const char*>(&head[4]), 4);
    checksum_ = ::crc32(0, &head[4], 4);
    return true;
  }
  const std::string& type() const { return type_; }
  /// Bytes of data of the chunk that have not been read.
  uint32_t left() const { return left_; }
  /// Reads at most `bytes` bytes of the chunk's data. Returns their count; 0 at the end of the file.
  size_t data(unsigned char* to, size_t bytes) {
    const size_t count = std::min<size_t>(bytes, left_);
    if (!read(to, count)) return 0;
    checksum_ = ::crc32(checksum_, to, static_cast<uInt>(count));
    left_ -= static_cast<uint32_t>(count);
    return count;
  }
  /// Reads the checksum that follows the data, and returns whether it matches. Call after reading all data.
  bool is_intact() {
    std::array<unsigned char, 4> stored{};
    return left_ == 0 && read(stored.data(), stored.size()) && big_endian(stored.data()) == checksum_;
  }
  /// Skips the rest of the chunk and its checksum.
  bool skip() { return !!file_.ignore(std::streamsize(left_) + 4); }

 private:
  std::ifstream file_;
  std::string type_;
  uint32_t left_ = 0;
  uLong checksum_ = 0;
};

/// Reads everything before the pixels. Returns nothing when the file is not a plain PNG.
std::optional<TexelLayout> read_png_header(Chunks& chunks) {
  std::array<unsigned char, 8> signature{};
  std::array<unsigned char, 13> head{};
  if (!chunks.read(signature.data(), signature.size()) ||
      std::string_view(reinterpret_cast<const char*>(signature.data()), 8) != "\x89PNG\r\n\x1a\n"sv)
    return {};
  if (!chunks.next() || chunks.type() != "IHDR" || chunks.left() != head.size()) return {};
  if (chunks.data(head.data(), head.size()) != head.size() || !chunks.is_intact()) return {};
  const uint32_t width = big_endian(head.data()), height = big_endian(&head[4]);
  const int bits = head[8], color = head[9];
  const bool other_methods = head[10] != 0 || head[11] != 0 || head[12] != 0;
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide || other_methods) return {};
  if ((bits != 8 && bits != 16) || (color != 0 && color != 2 && color != 4 && color != 6)) return {};
  while (chunks.next() && chunks.type() != "IEND" && chunks.type() != "PLTE" && chunks.type() != "tRNS") {
    if (chunks.type() == "IDAT") {
      const int channels = (color & 2 ? 3 : 1) + (color & 4 ? 1 : 0);
      return TexelLayout{static_cast<int>(width), static_cast<int>(height), channels,
                         bits == 8 ? TexelKind::kU8 : TexelKind::kU16};
    }
    if (!chunks.skip()) return {};
  }
  return {};
}

/// Decompresses the data of consecutive IDAT chunks.
class Inflater {
 public:
  explicit Inflater(Chunks& chunks) : chunks_(chunks), input_(kInput) {
    if (::inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { ::inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Fills `to`. Throws Damage when the data are damaged or too short.
  void read(unsigned char* to, size_t bytes) {
    stream_.next_out = to;
    stream_.avail_out = static_cast<uInt>(bytes);
    while (stream_.avail_out > 0) {
      if (stream_.avail_in == 0) fill();
      const int state = ::inflate(&stream_, Z_NO_FLUSH);
      ended_ = state == Z_STREAM_END;
      if (ended_ && stream_.avail_out > 0) throw Damage("is truncated");
      if (state != Z_OK && !ended_) throw Damage("is damaged: its pixels cannot be decompressed");
    }
  }

  /// Checks the checksums, after all bytes were read. Ignores further bytes.
  void finish() {
    unsigned char more = 0;
    stream_.next_out = &more;
    stream_.avail_out = 1;
    while (!ended_ && stream_.avail_out > 0) {
      if (stream_.avail_in == 0) fill();
      const int state = ::inflate(&stream_, Z_NO_FLUSH);
      ended_ = state == Z_STREAM_END;
      if (state != Z_OK && !ended_) throw Damage("is damaged: its pixels cannot be decompressed");
    }
    if (chunks_.left() == 0 && !chunks_.is_intact())
      throw Damage("is damaged: a checksum of its pixels is wrong");
  }

 private:
  void fill() {
    while (chunks_.left() == 0) {
      if (!chunks_.is_intact()) throw Damage("is damaged: a checksum of its pixels is wrong");
      if (!chunks_.next() || chunks_.type() != "IDAT") throw Damage("is truncated");
    }
    const size_t count = chunks_.data(input_.data(), input_.size());
    if (count == 0) throw Damage("is truncated");
    stream_.next_in = input_.data();
    stream_.avail_in = static_cast<uInt>(count);
  }

  Chunks& chunks_;
  std::vector<unsigned char> input_;
  z_stream stream_{};
  bool ended_ = false;
};

unsigned char paeth(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int to_left = std::abs(guess - left), to_up = std::abs(guess - up);
  const int to_corner = std::abs(guess - corner);
  if (to_left <= to_up && to_left <= to_corner) return static_cast<unsigned char>(left);
  return static_cast<unsigned char>(to_up <= to_corner ? up : corner);
}

/// Undoes the filter of a row. `above`: the row above, zeros for the first. `step`: bytes of a texel.
void unfilter(int filter, std::vector<unsigned char>& row, const std::vector<unsigned char>& above,
              size_t step) {
  if (filter > 4) throw Damage("is damaged: a row has an unknown filter");
  for (size_t i = 0; i < row.size(); ++i) {
    const int left = i >= step ? row[i - step] : 0, up = above[i];
    const int corner = i >= step ? above[i - step] : 0;
    const int predicted = filter == 0   ? 0
                          : filter == 1 ? left
                          : filter == 2 ? up
                          : filter == 3 ? (left + up) / 2
                                        : paeth(left, up, corner);
    row[i] = static_cast<unsigned char>(row[i] + predicted);
  }
}

void read_png_rows(Chunks& chunks, const TexelLayout& layout, size_t strip_rows, ImageSink& sink) {
  Inflater inflater(chunks);
  std::vector<unsigned char> row(layout.row_bytes()), above(row.size());
  std::vector<std::byte> strip;
  strip.reserve(strip_rows * row.size());
  const auto height = static_cast<size_t>(layout.height);
  for (size_t y = 0; y < height; ++y) {
    unsigned char filter = 0;
    inflater.read(&filter, 1);
    inflater.read(row.data(), row.size());
    unfilter(filter, row, above, layout.texel_bytes());
    const auto bytes = std::as_bytes(std::span(row));
    strip.insert(strip.end(), bytes.begin(), bytes.end());
    if (layout.kind == TexelKind::kU16 && std::endian::native == std::endian::little) {
      for (size_t i = strip.size() - row.size(); i < strip.size(); i += 2) std::swap(strip[i], strip[i + 1]);
    }
    std::swap(row, above);
    if ((y + 1) % strip_rows != 0 && y + 1 != height) continue;
    sink.rows(strip.data(), static_cast<int>(strip.size() / row.size()));
    strip.clear();
  }
  inflater.finish();
}

}  // namespace

std::optional<std::string> read_plain_png(const std::filesystem::path& file, ImageSink& sink) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".png") return {};
  Chunks chunks(file);
  const std::optional<TexelLayout> layout = read_png_header(chunks);
  if (!layout) return {};
  const size_t values = layout->row_bytes() / value_bytes(layout->kind);
  const size_t strip = std::clamp<size_t>(kStripValues / values, 1, static_cast<size_t>(layout->height));
  sink.begin(
      {*layout, true, static_cast<int64_t>((strip + 2) * layout->row_bytes() + kInput) + kInflateBytes});
  try {
    read_png_rows(chunks, *layout, strip, sink);
  } catch (const Damage& error) {
    return error.what();
  }
  return "";
}

}  // namespace pelage
