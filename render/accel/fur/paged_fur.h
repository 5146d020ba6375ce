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

/// A hit of one of several trees.
struct PagedFurHit {
  FurHit hit;
  uint32_t tree = 0;

  explicit operator bool() const { return bool(hit); }
  /// Nearer; or as near, and of the smaller tree or segment.
  bool precedes(const PagedFurHit& o) const {
    if (hit.distance == o.hit.distance && tree != o.tree) return tree < o.tree;
    return hit.precedes(o.hit);
  }
};

/// Where a ray starts that leaves a strand: in which tree, and where there.
struct PagedFurStart {
  FurStart start;
  uint32_t tree = 0;
};

struct PagedFurCounts {
  int64_t box_tests = 0;  ///< rays against boxes above the treelets
  int64_t treelet_visits = 0;
  FurTests tests;  ///< within treelets, where `count_tests` is set
  bool count_tests = false;
};

struct PagedFurOptions {
  int threads = 1;            ///< numbers of threads are below it
  uint64_t memory_limit = 0;  ///< bytes that the ledger's budgeted tags may reach; 0 = no limit
  /// Of each thread, how many rays may wait for pages at once. What they hold, 64 bytes each, is taken and
  /// charged from the beginning. 0: every ray waits alone, for one page after the other.
  size_t waiting_rays = size_t(1) << 14;
  bool poison = false;  ///< pages are overwritten when they are dropped, for tests
};

/// Rays against fur trees whose pages are read from a file when a ray needs them and dropped when the memory
/// limit asks for it. Resident are the tree over the boxes of all treelets, the table, room for rays that
/// wait, and the pages that a Residency holds. A ray's answer is a function of the ray and the segments: the
/// same as that of the trees in memory, whatever is resident.
///
/// Errors of the file pass through the queries. Thread safety: const members from any thread, each number
/// `thread` by one thread at a time and inside a FlushDenormals scope.
class PagedFur {
 public:
  /// Throws Error (kMemory) when the limit does not hold what is always held and a page.
  PagedFur(FurPageFile file, const PagedFurOptions& options, MemoryLedger& ledger, const Workers& workers);
  ~PagedFur();
  /// The memory limit that holds `share` of all pages, and what is held beside them. That of `options` does
  /// not matter.
  static uint64_t bytes_for(const FurPageFile& file, double share, const PagedFurOptions& options,
                            const Workers& workers);

  /// The hit in (near, far) that stands first.
  PagedFurHit closest(const Ray& ray, const PagedFurStart& start, int thread, PagedFurCounts& counts) const;
  /// Whether there is any hit in (near, far). Pages that are not resident are asked last.
  bool occluded(const Ray& ray, const PagedFurStart& start, int thread, PagedFurCounts& counts) const;

  /// The same for many rays at once. A ray that comes to a page which is not resident waits, and others go
  /// on; when as many wait as may, or all, the page that most of them wait for is read, for all of those.
  /// Every ray visits its treelets front to back, or, where anything in its way will do, what is resident
  /// first, as it does alone. `starts` is empty or as long as `rays`, and so are
  /// the answers, which are the same.
  void closest(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
               std::span<PagedFurHit> hits, PagedFurCounts& counts) const;
  void occluded(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                std::span<uint8_t> answers, PagedFurCounts& counts) const;

  const FurPageTable& table() const { return file_.table(); }
  /// Expansions are pages read.
  ResidencyCounts counts() const { return residency_->counts(); }
  uint64_t bytes_read() const;

 private:
  class Pages;
  template <class Query>
  class Batch;
  struct Nearest;
  struct Any;

  /// Of a ray as the boxes of treelets stand.
  ChunkWalk walk(const Ray& ray, ChunkWalk::Order order) const;

  /// What asks for one ray: the treelet is visited, its page is pinned meanwhile. False ends the ray.
  template <class Query>
  bool visit(uint32_t treelet, Query& query, int thread, PagedFurCounts& counts) const;
  bool rays_may_wait() const { return waiting_rays_ > 0; }
  bool is_resident(uint32_t treelet) const { return residency_->is_resident(table().treelets[treelet].page); }

  const FurPageFile file_;
  const size_t waiting_rays_;  // of each thread
  const FurFrame frame_;       // in which tree_ stands
  std::unique_ptr<ChunkTree> tree_;
  size_t fixed_bytes_ = 0;
  MemoryCharge charge_;
  std::unique_ptr<Pages> pages_;
  std::unique_ptr<Residency> residency_;
  mutable std::vector<WaitingRays> waiting_;  // by thread
};

}  // namespace pelage
