// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/job.h"
#include "geom/io/strand_file.h"

namespace pelage {

class RawStrands;

/// A strand file that stays on the disk: strands are read, and repaired, each time that they are asked for.
/// They are the strands that read_strands() gives, by the same numbers. Held are a few bytes a strand at
/// most. The file may be replaced by another meanwhile, but not be changed in place. Immutable. Thread
/// safety: const members may be called from any thread.
class StrandReader {
 public:
  using Visit = std::function<void(size_t first, const Strands& strands)>;

  /// Opens the file and checks its header against its length. Throws Error (kInput).
  StrandReader(const std::filesystem::path& path, const StrandReadOptions& options);
  ~StrandReader();
  StrandReader(StrandReader&&) noexcept;

  /// How many strands the file claims, for estimates before scan().
  size_t strands_in_file() const;
  /// The points of all of them.
  size_t points_in_file() const;
  /// Reads the whole file once, a few at a time, and hands out all usable strands in order; `first` is the
  /// number of the first of them. Called once, before everything that follows. Throws Error (kInput), Error
  /// (kStopped).
  void scan(const Job& job, const Visit& visit);

  /// The same once more.
  void read_all(const Job& job, const Visit& visit) const;

  size_t strand_count() const { return count_; }
  CurveBasis basis() const;
  const StrandRepairs& repairs() const { return repairs_; }
  /// Points of a strand.
  uint32_t points(size_t strand) const { return points_.empty() ? common_points_ : points_[strand]; }
  uint32_t max_points() const { return max_points_; }
  /// Names, frequencies and components of the strands' attributes; values of constant ones alone.
  std::span<const StrandAttribute> attributes() const;

  /// Some strands by their numbers, which ascend. Throws Error (kFailed) when the file has changed.
  Strands read(std::span<const uint32_t> strands) const;
  size_t bytes() const;

 private:
  /// Where a strand is in the file.
  size_t place(size_t strand) const { return places_.empty() ? strand : places_[strand]; }
  void for_each_strands(const Job& job, const std::function<void(const StrandFile&)>& visit) const;
  [[noreturn]] void fail_changed() const;
  void find_width(const Job& job);
  void note(const Strands& strands);

  std::unique_ptr<const RawStrands> raw_;
  float width_ = 0;  // of strands without one; 0 until it is known
  size_t count_ = 0;
  uint32_t common_points_ = 0, max_points_ = 0;
  std::vector<uint32_t> points_;  // empty where all strands have equally many
  std::vector<uint32_t> places_;  // empty where every strand of the file is usable
  StrandRepairs repairs_;
};

}  // namespace pelage
