// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/io/strand_reader.h"
#include "groom/follicles.h"
#include "groom/groom_params.h"
#include "groom/operator.h"
#include "groom/strand_batch.h"

namespace pelage {

class ProgressStage;

/// The strands of a file that a groom starts from. Either every strand is bound to the nearest point of the
/// rest skin, or the strands have no skin. The strands stay in the file; only their positions are kept in
/// memory. Immutable. Thread safety: const members may be called from any thread.
class ImportedStrands {
 public:
  /// `rest` may be null: no skin. `owner` is for messages. Warns through the job about strands that are too
  /// far from the skin to follow it. Throws Error: kInput when the file cannot be read, kMemory (before
  /// reading) when its strands do not fit, kStopped when the job is stopped.
  ImportedStrands(const GroomParams& params, const LimitSurface* rest, const std::string& owner,
                  const Job& job);

  const FollicleTree& follicles() const { return follicles_; }
  /// Whether the strands have no skin.
  bool is_free() const { return free_; }
  CurveBasis basis() const { return reader_.basis(); }
  const StrandRepairs& repairs() const { return reader_.repairs(); }
  int strand_points(size_t follicle) const { return static_cast<int>(reader_.points(places()[follicle])); }

  int max_points() const { return static_cast<int>(reader_.max_points()); }

  /// Number of follicles from `begin`, up to `end` at most, that can share a batch because they have the same
  /// number of points.
  size_t run_length(size_t begin, size_t end) const;
  /// Rest roots of strands without a skin: their first points, with frames along the axes.
  void place_free(StrandBatch& batch, size_t begin) const;
  /// Sets points and radii from the file; points are offsets from the rest roots, which must be set before.
  void start(StrandBatch& batch, size_t begin) const;
  /// Properties of the strands of a leaf.
  const StrandReach& reach(size_t leaf) const { return reach_[leaf]; }
  /// First point of the strand of a follicle without a skin, in the space of the file.
  const V3f& first_point(size_t follicle) const { return free_roots_[follicle]; }
  /// Attributes from the file for the given follicles: all attributes except the one named `except`.
  std::vector<StrandAttribute> attributes(std::span<const uint32_t> follicles, std::string_view except) const;
  /// Number of floats that attributes() returns for the follicles [begin, end).
  size_t attribute_floats(size_t begin, size_t end, std::string_view except) const;
  size_t bytes() const;

 private:
  void find_reach(std::span<const V3f> roots, const Job& job, const ProgressStage& stage);
  Strands read(size_t begin, size_t end) const;
  /// Number of the strand of each follicle; ascends within a leaf.
  std::span<const uint32_t> places() const { return place_.empty() ? follicles_.ids() : place_; }

  StrandReader reader_;
  bool free_ = true;
  FollicleTree follicles_;
  std::vector<uint32_t> place_;     // empty if every strand of the file is usable: then its id is its index
  std::vector<V3f> free_roots_;     // of strands without a skin
  std::vector<StrandReach> reach_;  // per leaf
};

}  // namespace pelage
