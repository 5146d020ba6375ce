// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"
#include "geom/limit_surface.h"
#include "geom/strands.h"
#include "image/field.h"

namespace pelage {

struct Job;

/// Kind of hair of a groom; each role has its own budget when detail is reduced.
enum class StrandRole { kGuard, kUnder, kWhisker };
template <>
struct EnumNames<StrandRole> {
  static constexpr const char* names[] = {"guard", "under", "whisker"};
};

struct FollicleOptions {
  int64_t count = 0;    ///< total number of strands; 0: `per_area` decides
  double per_area = 0;  ///< strands per square scene unit of the rest limit surface where the density is 1
  Field density{1.0f};  ///< relative density over the skin, >= 0
  std::function<float(const V3f& rest, const V3f& normal)> coverage;  ///< factor on the density; may be empty
  uint64_t seed = 0;
  int leaf_strands = 8000;
  std::string owner = "groom";   ///< name of the owner of the follicles, for messages
  std::string noun = "strands";  ///< name of the placed objects in the plural, for messages
};

/// Memory that suffices for placing `count` follicles, including the tree (progressive_order.h). If the
/// ledger has room for twice as much, up to 340,000 follicles are placed with twice as much memory, in less
/// time.
int64_t follicle_temporary_bytes(int64_t count);
/// Memory of a tree of `count` follicles, without its leaves.
int64_t follicle_bytes(int64_t count);

/// Roots of the strands of a groom: progressive blue noise on the rest limit surface, in a fixed hierarchy.
///
/// A follicle's id is its rank in the progressive order: every prefix of the ids is blue noise, so an id is
/// also the LOD priority (law 3). Ids depend only on the rest surface, the density and the seed (law 2), not
/// on leaf_strands or threads. Follicles are stored leaf by leaf, ordered by id within each; leaves are
/// compact in space. Immutable. Thread safety: const members may be called from any thread.
class FollicleTree {
 public:
  /// Max number of follicles of one groom.
  static constexpr int64_t kMaxFollicles = 500'000'000;

  struct Leaf {
    uint32_t begin = 0, end = 0;  ///< follicles
    Box3f rest_roots;             ///< box of their rest positions
  };

  /// The tree is empty if the density is 0 everywhere. Throws Error: kInput for more than kMaxFollicles,
  /// kMemory before making anything for which the ledger has no room, kStopped when the job is stopped.
  static FollicleTree build(const LimitSurface& rest, const FollicleOptions& options, const Job& job);
  /// The same hierarchy over given positions with ascending ids. `roots` is empty for strands without a skin.
  /// `order` receives the index of each follicle's position.
  static FollicleTree over(std::span<const V3f> rest_positions, std::span<const RootAddress> roots,
                           std::span<const uint32_t> ids, int leaf_strands, const Job& job,
                           std::vector<uint32_t>& order);

  /// A tree from its stored parts: leaves must be consecutive and cover all follicles.
  static FollicleTree of(std::vector<Leaf> leaves, std::vector<uint32_t> ids, std::vector<RootAddress> roots);

  size_t size() const { return ids_.size(); }
  /// Whether the follicles are on a skin; the roots of imported strands may not be.
  bool has_roots() const { return !roots_.empty(); }
  std::span<const Leaf> leaves() const { return leaves_; }
  uint64_t id(size_t follicle) const { return ids_[follicle]; }
  const RootAddress& root(size_t follicle) const { return roots_[follicle]; }
  std::span<const uint32_t> ids() const { return ids_; }
  std::span<const RootAddress> roots() const { return roots_; }
  size_t bytes() const;

 private:
  std::vector<Leaf> leaves_;
  std::vector<uint32_t> ids_;
  std::vector<RootAddress> roots_;
};

}  // namespace pelage
