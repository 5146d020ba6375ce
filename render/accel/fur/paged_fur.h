// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/ledger.h"
#include "cache/residency.h"
#include "render/accel/chunk_tree.h"
#include "render/accel/fur/fur_page_file.h"
#include "render/accel/fur/waiting_rays.h"

namespace pelage {

/// A hit in one of several trees.
struct PagedFurHit {
  FurHit hit;
  uint32_t tree = 0;

  explicit operator bool() const { return bool(hit); }
  /// Whether this hit is nearer than `o`; or equally near, in a tree with a smaller number; or equally near,
  /// in the same tree, on a segment with a smaller number.
  bool precedes(const PagedFurHit& o) const {
    if (hit.distance == o.hit.distance && tree != o.tree) return tree < o.tree;
    return hit.precedes(o.hit);
  }
};

/// Where a ray leaves a strand: the number of the strand's tree, and the position in that tree.
struct PagedFurStart {
  FurStart start;
  uint32_t tree = 0;
};

struct PagedFurCounts {
  int64_t box_tests = 0;  ///< tests of rays against boxes above the treelets
  int64_t treelet_visits = 0;
  FurTests tests;  ///< within treelets; not counted unless `count_tests` is set
  bool count_tests = false;
};

struct PagedFurOptions {
  int threads = 1;            ///< every `thread` number of a query is less than this
  uint64_t memory_limit = 0;  ///< max bytes of the ledger's budgeted tags; 0 = no limit
  /// Max number of rays per thread that wait for pages at the same time. The constructor allocates and
  /// charges 64 bytes for each of them. 0: queries of many rays trace one ray after the other, and each ray
  /// waits for one page after the other.
  size_t waiting_rays = size_t(1) << 14;
  bool poison = false;  ///< overwrites pages when they are evicted, for tests
};

/// Intersects rays with fur trees whose pages are read from a file on demand, and evicted to stay within the
/// memory limit. The tree over the boxes of all treelets, the table and the memory of waiting rays are always
/// resident. A Residency holds the pages. The result of a query is a function of the ray and the segments. It
/// equals the result for the same trees in memory and does not depend on which pages are resident.
///
/// Queries throw the errors of reading the file. Thread safety: const members from any thread, but a `thread`
/// number may be used by only one thread at a time. Each query must be inside a FlushDenormals scope.
class PagedFur {
 public:
  /// Throws Error (kMemory) when the limit is too small for the always resident part and one page.
  PagedFur(FurPageFile file, const PagedFurOptions& options, MemoryLedger& ledger, const Workers& workers);
  ~PagedFur();
  /// Returns the memory limit, in bytes, that suffices for the always resident part and the fraction `share`
  /// of all pages. Ignores `options.memory_limit`.
  static uint64_t bytes_for(const FurPageFile& file, double share, const PagedFurOptions& options,
                            const Workers& workers);

  /// Returns the first hit in (near, far), in the order of PagedFurHit::precedes(); an empty hit if there is
  /// none.
  PagedFurHit closest(const Ray& ray, const PagedFurStart& start, int thread, PagedFurCounts& counts) const;
  /// Whether there is any hit in (near, far). Postpones treelets (up to 64) whose pages are not resident
  /// until all other treelets have been tested.
  bool occluded(const Ray& ray, const PagedFurStart& start, int thread, PagedFurCounts& counts) const;

  /// Answer the same queries for many rays at once. A ray that needs a page that is not resident waits while
  /// other rays continue. When the max number of rays wait, or when all remaining rays wait, the thread reads
  /// the page for which the most rays wait; these rays then continue. As in single queries, closest() visits
  /// the treelets of a ray front to back, and occluded() visits the resident treelets first. `starts` must be
  /// empty or as long as `rays`. `hits` and `answers` must be as long as `rays`. They receive the answers of
  /// the single queries; an occlusion answer is 0 or 1.
  void closest(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
               std::span<PagedFurHit> hits, PagedFurCounts& counts) const;
  void occluded(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                std::span<uint8_t> answers, PagedFurCounts& counts) const;

  const FurPageTable& table() const { return file_.table(); }
  /// Counts for pages; an expansion is the reading of a page.
  ResidencyCounts counts() const { return residency_->counts(); }
  uint64_t bytes_read() const;

 private:
  class Pages;
  template <class Query>
  class Batch;
  struct Nearest;
  struct Any;

  /// Returns a traversal of the treelets' boxes by a ray.
  ChunkWalk walk(const Ray& ray, ChunkWalk::Order order) const;

  /// Tests one treelet for one ray while the treelet's page is pinned. Returns false when the ray is
  /// finished.
  template <class Query>
  bool visit(uint32_t treelet, Query& query, int thread, PagedFurCounts& counts) const;
  bool rays_may_wait() const { return waiting_rays_ > 0; }
  bool is_resident(uint32_t treelet) const { return residency_->is_resident(table().treelets[treelet].page); }

  const FurPageFile file_;
  const size_t waiting_rays_;  // per thread
  const FurFrame frame_;       // frame of tree_
  std::unique_ptr<ChunkTree> tree_;
  size_t fixed_bytes_ = 0;
  MemoryCharge charge_;
  std::unique_ptr<Pages> pages_;
  std::unique_ptr<Residency> residency_;
  mutable std::vector<WaitingRays> waiting_;  // by thread
};

}  // namespace pelage
