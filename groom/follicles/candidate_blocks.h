// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/four_lanes.h"
#include "groom/follicles/follicle_candidates.h"

namespace pelage {

/// A follicle as candidates see it.
struct PlacedFollicle {
  float x, y, z;
  uint32_t normal;  // pack_normal()
  float spacing;
};

/// The follicles near a block of candidates, in the order in which a loop over four lanes reads them. A
/// thread uses this object for block after block.
class NearFollicles {
 public:
  /// Removes all follicles. Makes room for `max`.
  void clear(size_t max) {
    size_ = 0;
    if (groups_.size() < max / 4 + 1) groups_.resize(max / 4 + 1);
  }
  /// Adds a follicle, for which there must be room.
  void add(const PlacedFollicle& follicle);
  /// Fills the last group of four. Call this after the last add().
  void finish();
  /// Returns the distance from a candidate to the nearest follicle, divided by the smaller of their spacings.
  /// Returns `radius` if there is none within `radius`. Ignores follicles whose normals differ by more than
  /// 60 degrees from the candidate's normal.
  float nearest(const FollicleCandidate& candidate, float radius) const;

 private:
  struct Group {
    FourVectors at, normal;
    Four spacing;
  };
  std::vector<Group> groups_;
  size_t size_ = 0;
};

/// A tree over blocks of candidates that are neighbours in space. Each block lists the follicles that may be
/// within the forbidden radius of one of its candidates. add() enters a follicle into all these lists. The
/// radius must never grow.
class CandidateBlocks {
 public:
  static constexpr size_t kBlock = 64;  // candidates per block

  /// `candidates` are sorted so that neighbours in space are adjacent. `max_listed`: max number of entries in
  /// all lists.
  CandidateBlocks(std::span<const FollicleCandidate> candidates, size_t max_follicles, size_t max_listed);
  /// Memory for a number of candidates, without the follicles and the lists.
  static size_t tree_bytes(size_t candidates);
  static size_t list_bytes(size_t max_listed) { return max_listed * sizeof(uint32_t); }

  size_t size() const { return lists_.size(); }
  uint32_t follicle_count() const { return static_cast<uint32_t>(follicles_.size()); }
  /// Adds a follicle. Returns false if there is no room for the lists.
  bool add(const FollicleCandidate& follicle, float radius);
  /// Collects the follicles that are near a block, and forgets those of its list that are too far away.
  /// Thread safe for different blocks, while no thread calls add().
  void gather(size_t block, float radius, NearFollicles& out);
  /// As gather(), but keeps and collects follicles that are too far away, which takes less time.
  void gather_all(size_t block, NearFollicles& out) const;
  /// As NearFollicles::nearest(), but among the follicles `first` and later ones.
  float nearest_of_latest(size_t block, const FollicleCandidate& candidate, float radius,
                          uint32_t first) const;

 private:
  static constexpr size_t kFan = 8;
  /// Boxes and largest spacings of eight nodes.
  struct Group {
    std::array<std::array<float, kFan>, 3> low, high;
    std::array<float, kFan> spacing;

    /// Whether a follicle may be too close to a candidate of a lane. All operations round monotonically, as
    /// those of NearFollicles::nearest() do: a box is never farther away than a candidate in it.
    bool meets(size_t lane, const PlacedFollicle& follicle, float radius) const {
      const float dx = std::max({low[0][lane] - follicle.x, follicle.x - high[0][lane], 0.0f});
      const float dy = std::max({low[1][lane] - follicle.y, follicle.y - high[1][lane], 0.0f});
      const float dz = std::max({low[2][lane] - follicle.z, follicle.z - high[2][lane], 0.0f});
      const float limit = radius * std::min(follicle.spacing, spacing[lane]);
      return dx * dx + dy * dy + dz * dz < limit * limit;
    }
  };
  static Group empty_group();
  static void extend(Group& group, size_t lane, const FollicleCandidate& candidate);
  bool visit(size_t level, size_t group, const PlacedFollicle& follicle, uint32_t index, float radius);
  bool list(size_t block, uint32_t follicle, float radius);
  bool is_near(size_t block, const PlacedFollicle& follicle, float radius) const;

  std::vector<std::vector<Group>> levels_;  // the first level is over blocks, the last has one group
  std::vector<std::vector<uint32_t>> lists_;
  std::vector<PlacedFollicle> follicles_;
  size_t max_listed_, listed_ = 0;  // entries for which the lists have room
};

}  // namespace pelage
