// SPDX-License-Identifier: Apache-2.0
#include "image/plain_png.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <new>
#include <vector>

#include <png.h>

#include "base/file.h"

namespace pelage {
namespace {

constexpr size_t kStripValues = size_t(1) << 18;
constexpr png_uint_32 kLargestPngSide = 1 << 16;
constexpr int64_t kLibraryBytes = int64_t(128) << 10;  // of libpng and zlib, without rows

/// A PNG file that libpng reads. libpng reports errors by a long jump; each function here returns false
/// instead, and no object with a destructor is alive where a jump may pass.
class PngFile {
 public:
  explicit PngFile(const std::filesystem::path& path)
      : file_(std::fopen(path.c_str(), "rb"), &std::fclose),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &error_, &note_error, &ignore_warning)) {
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngFile() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;

  /// Reads everything before the pixels.
  bool read_header() {
    if (!file_) return false;
    if (setjmp(png_jmpbuf(png_))) return false;
    png_init_io(png_, file_.get());
    png_read_info(png_, info_);
    if (std::endian::native == std::endian::little && png_get_bit_depth(png_, info_) == 16)
      png_set_swap(png_);
    return true;
  }
  /// Returns nothing when the file is not a plain PNG. Call after read_header().
  std::optional<TexelLayout> layout() const {
    const int bits = png_get_bit_depth(png_, info_), color = png_get_color_type(png_, info_);
    const png_uint_32 width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
    if ((bits != 8 && bits != 16) || color == PNG_COLOR_TYPE_PALETTE) return {};
    if (width > kLargestPngSide || height > kLargestPngSide) return {};
    if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) return {};
    if (png_get_valid(png_, info_, PNG_INFO_PLTE | PNG_INFO_tRNS) != 0) return {};
    return TexelLayout{static_cast<int>(width), static_cast<int>(height), png_get_channels(png_, info_),
                       bits == 8 ? TexelKind::kU8 : TexelKind::kU16};
  }
  /// Reads `count` rows. `to`: the first row; `row_bytes`: of each.
  bool read_rows(png_bytep to, size_t row_bytes, size_t count) {
    if (setjmp(png_jmpbuf(png_))) return false;
    for (size_t i = 0; i < count; ++i) png_read_row(png_, to + i * row_bytes, nullptr);
    return true;
  }
  /// Reads what follows the pixels, and verifies its checksums.
  bool read_end() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_end(png_, nullptr);
    return true;
  }
  /// What was wrong in the function that returned false.
  std::string error() const { return std::feof(file_.get()) ? "is truncated" : "is damaged: " + error_; }

 private:
  [[noreturn]] static void note_error(png_structp png, png_const_charp message) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    png_longjmp(png, 1);
  }
  static void ignore_warning(png_structp, png_const_charp) {}

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::string error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

std::optional<std::string> read_plain_png(const std::filesystem::path& file, ImageSink& sink) {
  if (lower_extension(file) != ".png") return {};
  PngFile png(file);
  if (!png.read_header()) return {};
  const std::optional<TexelLayout> layout = png.layout();
  if (!layout) return {};
  const size_t row_bytes = layout->row_bytes(), height = static_cast<size_t>(layout->height);
  const size_t strip = std::clamp<size_t>(kStripValues * value_bytes(layout->kind) / row_bytes, 1, height);
  sink.begin({*layout, true, static_cast<int64_t>((strip + 3) * row_bytes) + kLibraryBytes});
  std::vector<std::byte> rows(strip * row_bytes);
  for (size_t first = 0; first < height; first += strip) {
    const size_t count = std::min(strip, height - first);
    if (!png.read_rows(reinterpret_cast<png_bytep>(rows.data()), row_bytes, count)) return png.error();
    sink.rows(rows.data(), static_cast<int>(count));
  }
  return png.read_end() ? "" : png.error();
}

}  // namespace pelage
