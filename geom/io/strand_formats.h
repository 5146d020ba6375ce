// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "geom/interchange/geometry_file.h"
#include "geom/io/binary_file.h"
#include "geom/io/strand_file.h"

// Code shared by the file formats of geom/io/strand_file.h.

namespace pelage {

class AtomicFile;

/// Buffers reads from several arrays of a file, where the offset within each array increases in small steps.
/// A small read is copied from a window: a block of the file that was read earlier with one system call.
/// Windows are small as long as each of them answers only one read. For use by one thread.
class FileWindows {
 public:
  explicit FileWindows(const BinaryFile& file) : file_(file) {}
  void read_bytes(uint64_t offset, void* to, size_t count);
  void read(uint64_t offset, std::span<float> values) {
    read_bytes(offset, values.data(), values.size_bytes());
  }

 private:
  // Larger windows would be heap blocks with their own pages (base/heap.h), allocated and freed for every
  // read.
  static constexpr size_t kBytes = 12 << 10, kFewBytes = 512, kWindows = 6;
  struct Window {
    uint64_t begin = 0, used = 0;
    bool answered_more = true;  // than the read for which it was filled
    std::vector<std::byte> bytes;
  };
  const BinaryFile& file_;
  Window windows_[kWindows];
  uint64_t uses_ = 0;
};

/// The strands of an open file as they are stored, without repairs. The constructors have checked all sizes
/// that the file claims against its length. Thread safety: const members may be called from any thread.
class RawStrands {
 public:
  RawStrands(const std::filesystem::path& path, const char* format_name, const StrandReadOptions& options)
      : file(path), format(format_name), basis(options.basis.value_or(CurveBasis::kPinnedBSpline)) {}
  /// Strands in the memory of the host.
  RawStrands(const std::string& name, CurveBasis basis_of_strands, const char* format_name = "memory")
      : file(BinaryFile::InMemory{name}), format(format_name), basis(basis_of_strands) {}
  virtual ~RawStrands() = default;

  /// Index of the first point of a strand. For `strand` = strand_count, the total number of points.
  virtual uint32_t first_point(size_t strand) const = 0;
  /// Appends the strands [begin, end) to `arrays`, which empty() has made. Their ids are their indices in the
  /// file.
  virtual void append(size_t begin, size_t end, FileWindows& windows, StrandArrays& arrays) const = 0;
  /// Returns all strands, as append() does. May move them out, so nothing else can be read afterwards.
  virtual StrandArrays take_all() {
    StrandArrays arrays = empty();
    FileWindows windows(file);
    append(0, strand_count, windows, arrays);
    return arrays;
  }
  /// Memory of the table of first points; 0 if the format needs none.
  virtual size_t bytes() const { return 0; }

  /// Returns arrays without strands, with the basis and the attributes of the file.
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
  /// The common width that the file states when it has no width per point; 0 if it states none.
  float file_width = 0;
  std::vector<StrandAttribute> attributes;  ///< names and frequencies; values only for constant attributes
  std::vector<std::string> warnings;        ///< one line per kind of thing in the file that is not read
};

/// Strands that are in memory as a whole.
class HeldStrands : public RawStrands {
 public:
  /// Ids of the strands must be their indices. `root_uv`: whether texture coordinates of roots are passed on.
  HeldStrands(const std::string& name, const char* format_name, std::shared_ptr<const Strands> strands,
              bool root_uv = false);
  /// Owns the strands of a file, so that take_all() need not copy them. Keeps the texture coordinates of
  /// roots, the warnings, and whether the file has widths.
  HeldStrands(const std::filesystem::path& path, const char* format_name, CurvesFile read);
  uint32_t first_point(size_t strand) const override;
  void append(size_t begin, size_t end, FileWindows& windows, StrandArrays& arrays) const override;
  StrandArrays take_all() override;
  size_t bytes() const override { return strands_->bytes(); }

 private:
  HeldStrands(const std::string& name, const char* format_name, std::shared_ptr<Strands> own);

  std::shared_ptr<Strands> own_;  // strands_ if they are nobody else's
  const std::shared_ptr<const Strands> strands_;
  const bool root_uv_;
};

std::unique_ptr<RawStrands> open_hair(const std::filesystem::path& path, const StrandReadOptions& options);
/// Opens USD as text. All strands are then in memory.
std::unique_ptr<RawStrands> open_usd(const std::filesystem::path& path, const StrandReadOptions& options);
/// Opens Alembic. All strands are then in memory.
std::unique_ptr<RawStrands> open_alembic(const std::filesystem::path& path, const StrandReadOptions& options);
std::unique_ptr<RawStrands> open_tfx(const std::filesystem::path& path, const StrandReadOptions& options);
/// Opens strands of the host, or a file. Throws Error (kInput) if the data of the host is not strands.
std::unique_ptr<RawStrands> open_raw_strands(const AssetPath& asset, const StrandReadOptions& options);
/// Opens a file in the format that the extension of its name selects. Throws Error (kInput).
std::unique_ptr<RawStrands> open_raw_strands(const std::filesystem::path& path,
                                             const StrandReadOptions& options);
void write_hair(const std::filesystem::path& path, const Strands& strands, bool widths);
void write_usd(const std::filesystem::path& path, const Strands& strands, bool widths);
void write_alembic(const std::filesystem::path& path, const Strands& strands, bool widths);
void write_tfx(const std::filesystem::path& path, const Strands& strands, bool widths);
/// Attribute of points: 0 where the simulation of a .tfx file fixes the point, else 1.
inline constexpr const char* kMovable = "movable";
/// The value that files without this attribute imply: simulations fix roots only.
inline float usually_movable(const Strands& strands, size_t strand, size_t point) {
  return point == strands.first_point(strand) ? 0.0f : 1.0f;
}

/// Reads `count` records of `components` floats at `offset`, a few thousand at a time. Writes each record to
/// the first `components` floats of a point (x, y, z, r) of `points`.
void read_point_parts(FileWindows& file, uint64_t offset, int components, size_t count, float* points);

/// Calls `value(strand, point, out)` for every point of every strand, and writes the `components` floats that
/// `value` stores in `out`.
void write_per_point(AtomicFile& file, const Strands& strands, int components,
                     const std::function<void(size_t strand, size_t point, float* out)>& value);

/// Writes `components` values of an attribute at a point of a strand to `out`. If the attribute has fewer
/// components, repeats the last one.
void attribute_at(const StrandAttribute& attribute, size_t strand, size_t point, int components, float* out);

/// Appends the ids and first points of strands [begin, end) of a file to `arrays`.
void append_places(const RawStrands& raw, size_t begin, size_t end, StrandArrays& arrays);

/// Reads `count` values of an attribute at `offset`, each with all its components, and appends them.
void append_values(FileWindows& file, uint64_t offset, size_t count, StrandAttribute& attribute);

/// Returns the width that the file states for strands without a width, else the width in the options, else 0.
float stated_width(const RawStrands& raw, const StrandReadOptions& options);

/// Makes a StrandFile from the strands that were read, and repairs them. Strands without a width get `width`.
StrandFile finish_strands(StrandArrays arrays, const RawStrands& raw, float width);

/// Throws Error (kFailed) with `path` as position and `why` as message.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& why);

}  // namespace pelage
