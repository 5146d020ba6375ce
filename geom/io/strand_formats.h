// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geom/io/binary_file.h"
#include "geom/io/strand_file.h"

// Common parts of the formats behind geom/io/strand_file.h.

namespace pelage {

class AtomicFile;

/// Buffers reads at slightly increasing offsets in several arrays of a file: small reads are served from
/// windows that were read at once. For use by one thread.
class FileWindows {
 public:
  explicit FileWindows(const BinaryFile& file) : file_(file) {}
  void read_bytes(uint64_t offset, void* to, size_t count);
  void read(uint64_t offset, std::span<float> values) {
    read_bytes(offset, values.data(), values.size_bytes());
  }

 private:
  // Larger heap blocks would have their own pages (base/heap.h), allocated and freed for every read.
  static constexpr size_t kBytes = 12 << 10, kWindows = 6;
  struct Window {
    uint64_t begin = 0, used = 0;
    std::vector<std::byte> bytes;
  };
  const BinaryFile& file_;
  Window windows_[kWindows];
  uint64_t uses_ = 0;
};

/// The strands of an opened file as stored, not repaired. All sizes that the file claims have been checked
/// against its length. Thread safety: const members may be called from any thread.
class RawStrands {
 public:
  RawStrands(const std::filesystem::path& path, const char* format_name, const StrandReadOptions& options)
      : file(path), format(format_name), basis(options.basis.value_or(CurveBasis::kPinnedBSpline)) {}
  virtual ~RawStrands() = default;

  /// Index of the first point of a strand, or of the end after the last strand.
  virtual uint32_t first_point(size_t strand) const = 0;
  /// Appends the strands [begin, end) to arrays made by empty(); their ids are their indices in the file.
  virtual void append(size_t begin, size_t end, FileWindows& windows, StrandArrays& arrays) const = 0;
  /// Memory of the index of strands.
  virtual size_t bytes() const { return 0; }

  StrandArrays empty() const {
    StrandArrays arrays;
    arrays.basis = basis;
    arrays.first_point.push_back(0);
    arrays.attributes = attributes;
    return arrays;
  }

  const BinaryFile file;
  const char* const format;
  const CurveBasis basis;
  size_t strand_count = 0;
  bool has_widths = false;
  float file_width = 0;                     ///< width that a file without widths per point states; else 0
  std::vector<StrandAttribute> attributes;  ///< without values, except for constants
};

std::unique_ptr<RawStrands> open_hair(const std::filesystem::path& path, const StrandReadOptions& options);
std::unique_ptr<RawStrands> open_tfx(const std::filesystem::path& path, const StrandReadOptions& options);
/// Selects the format by the file name's extension. Throws Error (kInput).
std::unique_ptr<RawStrands> open_raw_strands(const std::filesystem::path& path,
                                             const StrandReadOptions& options);
void write_hair(const std::filesystem::path& path, const Strands& strands);
void write_tfx(const std::filesystem::path& path, const Strands& strands);

/// Reads `count` records of `components` floats at `offset`, a few thousand at a time. Writes them with a
/// stride of four floats to `points` (x, y, z, r).
void read_point_parts(FileWindows& file, uint64_t offset, int components, size_t count, float* points);

/// Calls `value(point, out)` for every point of every strand and writes the resulting `components` floats.
void write_per_point(AtomicFile& file, const Strands& strands, int components,
                     const std::function<void(size_t strand, size_t point, float* out)>& value);

/// Value of an attribute at a point of a strand; missing components are filled with the last one.
void attribute_at(const StrandAttribute& attribute, size_t strand, size_t point, int components, float* out);

/// Appends the ids and first points of strands [begin, end) of a file.
void append_places(const RawStrands& raw, size_t begin, size_t end, StrandArrays& arrays);

/// Appends `count` records of an attribute's floats at `offset`.
void append_values(FileWindows& file, uint64_t offset, size_t count, StrandAttribute& attribute);

/// The width that the file or the options state for strands without a width; else 0.
float stated_width(const RawStrands& raw, const StrandReadOptions& options);

/// Repairs the strands that were read. `width`: for strands without a width.
StrandFile finish_strands(StrandArrays arrays, const RawStrands& raw, float width);

/// Throws Error (kFailed): "path: why".
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& why);

}  // namespace pelage
