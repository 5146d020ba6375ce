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

/// Kind of hair of a groom. When detail is reduced, each role has its own budget.
enum class StrandRole { kGuard, kUnder, kWhisker };
template <>
struct EnumNames<StrandRole> {
  static constexpr const char* names[] = {"guard", "under", "whisker"};
};

struct FollicleOptions {
  int64_t count = 0;  ///< number of strands; 0: `per_area` determines it
  /// Number of strands per square scene unit of the rest limit surface, where the density is 1.
  double per_area = 0;
  Field density{1.0f};  ///< relative density over the skin, >= 0
  /// Additional factor on the density; may be empty.
  std::function<float(const FieldPoint& root)> coverage;
  uint64_t seed = 0;
  int leaf_strands = 8000;
  std::string owner = "groom";   ///< owner of the follicles, for messages
  std::string noun = "strands";  ///< plural name of the objects that are placed, for messages
};

/// Returns the memory that suffices to place `count` follicles, including the tree. Placing up to 340,000
/// follicles uses twice this memory, and less time, if the ledger has room for it (progressive_order.h).
int64_t follicle_temporary_bytes(int64_t count);
/// Returns the memory of a tree of `count` follicles, without its leaves.
int64_t follicle_bytes(int64_t count);

/// Roots of the strands of a groom: progressive blue noise on the rest limit surface, sorted into leaves.
///
/// The id of a follicle is its rank in the progressive order. The follicles with ids below any n are blue
/// noise, so the id is also the priority for level of detail (law 3). Ids depend only on the rest surface,
/// the density and the seed (law 2), not on leaf_strands or the number of threads. Each leaf is compact in
/// space and holds consecutive follicles, in ascending order of id. Immutable. Thread safety: const members
/// may be called from any thread.
class FollicleTree {
 public:
  /// Max number of follicles of one groom.
  static constexpr int64_t kMaxFollicles = 500'000'000;

  struct Leaf {
    uint32_t begin = 0, end = 0;  ///< range of follicles: [begin, end)
    Box3f rest_roots;             ///< box of the follicles' rest positions
  };

  /// Places follicles. The tree is empty if the density is 0 everywhere. Throws Error: kInput for more than
  /// kMaxFollicles, kMemory before making anything for which the ledger has no room, kStopped when the job is
  /// stopped.
  static FollicleTree build(const LimitSurface& rest, const FollicleOptions& options, const Job& job);
  /// Makes a tree from given positions and their ascending ids. `roots` is empty for strands without a skin.
  /// Sets `order` to the index in `rest_positions` of each follicle.
  static FollicleTree over(std::span<const V3f> rest_positions, std::span<const RootAddress> roots,
                           std::span<const uint32_t> ids, int leaf_strands, const Job& job,
                           std::vector<uint32_t>& order);

  /// Makes a tree from the members of a stored tree. Leaves must be consecutive and cover all follicles.
  static FollicleTree of(std::vector<Leaf> leaves, std::vector<uint32_t> ids, std::vector<RootAddress> roots);

  size_t size() const { return ids_.size(); }
  /// Whether the follicles are on a skin. False for imported strands without a skin.
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
