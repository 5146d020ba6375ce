// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/job.h"
#include "base/value_readers.h"
#include "geom/io/strand_file.h"

namespace pelage {

class FileWindows;
class RawStrands;

/// A strand file that stays on disk, or strands in the memory of the host. The reader reads and repairs
/// strands each time they are requested. A strand's number is its index among the usable strands, which are
/// the strands that read_strands() returns. Keeps at most a few bytes per strand in memory. While the reader
/// is in use, the file may be replaced by another file, but must not be modified in place. Immutable after
/// scan(). Thread safety: const members may be called from any thread.
class StrandReader {
 public:
  using Visit = std::function<void(size_t first, const Strands& strands)>;

  /// Opens the file and checks its header against its length. Points and widths of the file are transformed
  /// by `to_scene` (row vectors: p * M) when they are read. Throws Error (kInput).
  StrandReader(const std::filesystem::path& path, const StrandReadOptions& options,
               const M44f& to_scene = M44f())
      : StrandReader(AssetPath{path, {}}, options, to_scene) {}
  StrandReader(const AssetPath& asset, const StrandReadOptions& options, const M44f& to_scene = M44f());
  ~StrandReader();
  StrandReader(StrandReader&&) noexcept;

  /// Number of strands that the file claims to have, for estimates before scan(). Includes unusable strands.
  size_t strands_in_file() const;
  /// Number of points that the file claims to have, including those of unusable strands.
  size_t points_in_file() const;
  /// Reads the whole file, a few strands at a time, and passes all usable strands to `visit` in order.
  /// `first` is the number of the first strand of the batch. Must be called exactly once, before the members
  /// below. Throws Error: kInput for a damaged file, kStopped when the job is stopped.
  void scan(const Job& job, const Visit& visit);

  /// Passes all usable strands to `visit` again, like scan(). May be called any number of times. Also throws
  /// Error (kFailed) when the file has changed.
  void read_all(const Job& job, const Visit& visit) const;

  /// Number of usable strands.
  size_t strand_count() const { return count_; }
  CurveBasis basis() const;
  const StrandRepairs& repairs() const { return repairs_; }
  /// Number of points of a usable strand after its repair.
  uint32_t points(size_t strand) const { return points_.empty() ? common_points_ : points_[strand]; }
  /// Max of points() over all strands.
  uint32_t max_points() const { return max_points_; }
  /// Names, frequencies and components of the strands' attributes. Only constant attributes have values here.
  std::span<const StrandAttribute> attributes() const;

  /// Reads the strands with the given numbers, which must be ascending. Throws Error (kFailed) when the file
  /// has changed.
  Strands read(std::span<const uint32_t> strands) const;
  size_t bytes() const;

 private:
  /// Index in the file of the strand with this number.
  size_t place(size_t strand) const { return places_.empty() ? strand : places_[strand]; }
  void for_each_strands(const Job& job, const std::function<void(const StrandFile&)>& visit) const;
  [[noreturn]] void fail_changed() const;
  void find_width(const Job& job);
  void append(size_t begin, size_t end, FileWindows& windows, StrandArrays& arrays) const;
  void note(const Strands& strands);

  std::unique_ptr<const RawStrands> raw_;
  M44f to_scene_;
  float width_ = 0;  // width of strands that have none; 0 until find_width()
  size_t count_ = 0;
  uint32_t common_points_ = 0, max_points_ = 0;
  std::vector<uint32_t> points_;  // number of points of each strand; empty when all have common_points_
  // index in the file of each strand; empty when every strand of the file is usable
  std::vector<uint32_t> places_;
  StrandRepairs repairs_;
};

}  // namespace pelage
