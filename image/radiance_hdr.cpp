// SPDX-License-Identifier: Apache-2.0
#include "image/radiance_hdr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

namespace pelage {
namespace {

constexpr size_t kLongestLine = 4096, kMaxLines = 1000, kLongestSide = 1 << 16, kValuesAtOnce = 1 << 18;
constexpr const char *kTruncated = "is truncated", *kBadRun = "is damaged: a run does not fit its row";

/// Red, green, blue, and the exponent of all three.
using Rgbe = std::array<uint8_t, 4>;

/// A Radiance file, read in order. Functions that read pixels return null, or the problem.
class RadianceFile {
 public:
  explicit RadianceFile(const std::filesystem::path& path)
      : file_(std::fopen(path.c_str(), "rb"), &std::fclose) {}

  /// Reads everything before the pixels. Returns the line with axes and size, or nothing when this is no
  /// Radiance file with RGBE pixels.
  std::optional<std::string> read_header() {
    if (!file_ || !read_line().value_or("").starts_with("#?")) return {};
    bool is_rgbe = false;
    for (size_t i = 0; i < kMaxLines; ++i) {
      const std::optional<std::string> line = read_line();
      if (!line) return {};
      if (line->empty()) return is_rgbe ? read_line() : std::nullopt;
      if (line->starts_with("FORMAT=")) is_rgbe = *line == "FORMAT=32-bit_rle_rgbe";
    }
    return {};
  }

  const char* read_row(std::span<Rgbe> row) {
    Rgbe first{};
    if (!read(first)) return kTruncated;
    const bool is_coded =
        row.size() >= 8 && row.size() < (1 << 15) && first[0] == 2 && first[1] == 2 && first[2] < (1 << 7);
    if (!is_coded) return read_pixels(first, row);
    if ((size_t(first[2]) << 8 | first[3]) != row.size()) return "is damaged: a row has another width";
    for (size_t channel = 0; channel < first.size(); ++channel) {
      if (const char* problem = read_channel(row, channel)) return problem;
    }
    return nullptr;
  }

 private:
  /// Without the line feed; nothing at the end of the file.
  std::optional<std::string> read_line() {
    std::string line;
    for (int c = std::fgetc(file_.get()); c != EOF; c = std::fgetc(file_.get())) {
      if (c == '\n') return line;
      if (line.size() == kLongestLine) return {};
      line += static_cast<char>(c);
    }
    return {};
  }

  bool read(Rgbe& pixel) { return std::fread(pixel.data(), pixel.size(), 1, file_.get()) == 1; }

  /// Bytes up to 128 count values that follow; larger ones repeat the next value.
  const char* read_channel(std::span<Rgbe> row, size_t channel) {
    for (size_t x = 0; x < row.size();) {
      const int head = ::getc_unlocked(file_.get());
      if (head == EOF) return kTruncated;
      const bool repeats = head > 128;
      const auto count = static_cast<size_t>(repeats ? head - 128 : head);
      if (count == 0 || count > row.size() - x) return kBadRun;
      int value = 0;
      for (const size_t begin = x; x < begin + count; ++x) {
        if (x == begin || !repeats) value = ::getc_unlocked(file_.get());
        if (value == EOF) return kTruncated;
        row[x][channel] = static_cast<uint8_t>(value);
      }
    }
    return nullptr;
  }

  /// A pixel (1, 1, 1, n) repeats the pixel before n times; directly after another such one, 256 n times, and
  /// so on. `pixel`: the first.
  const char* read_pixels(Rgbe pixel, std::span<Rgbe> row) {
    int shift = 0;
    for (size_t x = 0;;) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        if (x == 0 || shift > 16) return kBadRun;
        const size_t count = size_t(pixel[3]) << shift;
        if (count > row.size() - x) return kBadRun;
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
        x += count;
        shift += 8;
      } else {
        row[x++] = pixel;
        shift = 0;
      }
      if (x == row.size()) return nullptr;
      if (!read(pixel)) return kTruncated;
    }
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

void to_floats(std::span<const Rgbe> row, float* rgb) {
  for (const Rgbe& pixel : row) {
    const float scale = pixel[3] == 0 ? 0 : std::ldexp(1.0f, pixel[3] - (128 + 8));
    for (size_t c = 0; c < 3; ++c) *rgb++ = static_cast<float>(pixel[c]) * scale;
  }
}

}  // namespace

std::optional<std::string> read_radiance_hdr(const std::filesystem::path& path, ImageSink& sink) {
  RadianceFile file(path);
  const std::optional<std::string> axes = file.read_header();
  if (!axes) return {};
  std::array<char, 3> first_axis{}, second_axis{};
  int height = 0, width = 0;
  const bool has_size = std::sscanf(axes->c_str(), "%2[-+XY] %6d %2[-+XY] %6d", first_axis.data(), &height,
                                    second_axis.data(), &width) == 4;
  if (!has_size || std::min(height, width) < 1 || std::max(height, width) > int(kLongestSide)) return {};
  if (first_axis != std::array{'-', 'Y', '\0'} || second_axis != std::array{'+', 'X', '\0'})
    return "has the axes '" + *axes + "'; Pelage reads only -Y HEIGHT +X WIDTH";
  const TexelLayout layout{width, height, 3, TexelKind::kFloat};
  const size_t columns = static_cast<size_t>(width);
  const int strip = std::clamp(static_cast<int>(kValuesAtOnce / (3 * columns)), 1, height);
  const size_t working = static_cast<size_t>(strip) * layout.row_bytes() + columns * sizeof(Rgbe);
  sink.begin({layout, false, static_cast<int64_t>(working)});
  std::vector<Rgbe> row(columns);
  std::vector<float> rows(static_cast<size_t>(strip) * columns * 3);
  for (int first = 0; first < height; first += strip) {
    const int count = std::min(strip, height - first);
    for (int y = 0; y < count; ++y) {
      if (const char* problem = file.read_row(row)) return problem;
      to_floats(row, rows.data() + static_cast<size_t>(y) * columns * 3);
    }
    sink.rows(reinterpret_cast<const std::byte*>(rows.data()), count);
  }
  return "";
}

}  // namespace pelage
