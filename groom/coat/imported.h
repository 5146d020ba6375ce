// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/io/strand_reader.h"
#include "groom/coat/groom_params.h"
#include "groom/follicles/follicles.h"
#include "groom/operators/operator.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

class ProgressStage;

/// The strands of a file as input of a groom. Either every strand is bound to the nearest point of the rest
/// skin, or no strand has a skin. The points of the strands stay in the file; only the roots are kept in
/// memory. Immutable. Thread safety: const members may be called from any thread.
class ImportedStrands {
 public:
  /// `rest` is null for strands without a skin. `owner` is for messages. Warns through the job if the strands
  /// are too far from the skin to follow it. Throws Error: kInput when the file cannot be read; kMemory,
  /// before reading, when the strands do not fit; kStopped when the job is stopped.
  ImportedStrands(const GroomParams& params, const LimitSurface* rest, const std::string& owner,
                  const Job& job);

  const FollicleTree& follicles() const { return follicles_; }
  /// Whether the strands do not follow a skin.
  bool is_free() const { return free_; }
  CurveBasis basis() const { return reader_.basis(); }
  const StrandRepairs& repairs() const { return reader_.repairs(); }
  /// Number of points of a follicle's strand.
  int strand_points(size_t follicle) const { return static_cast<int>(reader_.points(places()[follicle])); }

  /// Max number of points of any strand.
  int max_points() const { return static_cast<int>(reader_.max_points()); }

  /// Returns the number of follicles from `begin` on, at most up to `end`, that fit one batch: their strands
  /// have the same number of points.
  size_t run_length(size_t begin, size_t end) const;
  /// Sets the rest roots of strands without a skin: their first points, with frames along the axes.
  void place_free(StrandBatch& batch, size_t begin) const;
  /// Sets the points and radii of a batch from the file. The rest roots of the batch must be set before,
  /// because points become offsets from them.
  void start(StrandBatch& batch, size_t begin) const;
  /// Returns bounds of the strands of a leaf.
  const StrandReach& reach(size_t leaf) const { return reach_[leaf]; }
  /// Returns the first point of the strand of a follicle without a skin, in the space of the file.
  const V3f& first_point(size_t follicle) const { return free_roots_[follicle]; }
  /// Reads the attributes of the strands of the given follicles: all attributes in the file except the one
  /// named `except`.
  std::vector<StrandAttribute> attributes(std::span<const uint32_t> follicles, std::string_view except) const;
  /// Returns the number of floats of attributes() for the follicles [begin, end).
  size_t attribute_floats(size_t begin, size_t end, std::string_view except) const;
  size_t bytes() const;

 private:
  void find_reach(std::span<const V3f> roots, const Job& job, const ProgressStage& stage);
  Strands read(size_t begin, size_t end) const;
  /// Number in reader_ of the strand of each follicle; ascends within a leaf.
  std::span<const uint32_t> places() const { return place_.empty() ? follicles_.ids() : place_; }

  StrandReader reader_;
  bool free_ = true;
  FollicleTree follicles_;
  // empty if every strand of the file is usable: its id is then its number in reader_
  std::vector<uint32_t> place_;
  std::vector<V3f> free_roots_;     // first points of strands without a skin
  std::vector<StrandReach> reach_;  // bounds of the strands of each leaf
};

}  // namespace pelage
