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
  /// Nearer; or equally near, with a smaller tree or segment number.
  bool precedes(const PagedFurHit& o) const {
    if (hit.distance == o.hit.distance && tree != o.tree) return tree < o.tree;
    return hit.precedes(o.hit);
  }
};

/// The start of a ray that leaves a strand: tree, and position in it.
struct PagedFurStart {
  FurStart start;
  uint32_t tree = 0;
};

struct PagedFurCounts {
  int64_t box_tests = 0;  ///< rays against boxes above the treelets
  int64_t treelet_visits = 0;
  FurTests tests;  ///< within treelets, with `count_tests`
  bool count_tests = false;
};

struct PagedFurOptions {
  int threads = 1;            ///< `thread` numbers are less than this
  uint64_t memory_limit = 0;  ///< max bytes of the ledger's budgeted tags; 0 = no limit
  /// Number of rays per thread that may wait for pages at once. Their memory, 64 bytes each, is allocated and
  /// charged from the start. 0: rays wait one at a time, for one page after the other.
  size_t waiting_rays = size_t(1) << 14;
  bool poison = false;  ///< overwrites pages when they are evicted, for tests
};

/// Intersection of rays with fur trees whose pages are read from a file on demand and evicted under the
/// memory limit. The tree over the boxes of all treelets, the table and the memory of waiting rays are always
/// resident. A Residency holds the pages. The result is a function of the ray and the segments. It equals the
/// result of trees in memory and does not depend on which pages are resident.
///
/// Errors of the file propagate through the queries. Thread safety: const members from any thread, each
/// `thread` number from one thread at a time and inside a FlushDenormals scope.
class PagedFur {
 public:
  /// Throws Error (kMemory) when the limit is too small for the always resident part and one page.
  PagedFur(FurPageFile file, const PagedFurOptions& options, MemoryLedger& ledger, const Workers& workers);
  ~PagedFur();
  /// The memory limit that holds `share` of all pages in addition to the always resident part. Ignores the
  /// limit of `options`.
  static uint64_t bytes_for(const FurPageFile& file, double share, const PagedFurOptions& options,
                            const Workers& workers);

  /// The first hit in (near, far) by precedes().
  PagedFurHit closest(const Ray& ray, const PagedFurStart& start, int thread, PagedFurCounts& counts) const;
  /// Whether there is any hit in (near, far). Tests pages that are not resident last.
  bool occluded(const Ray& ray, const PagedFurStart& start, int thread, PagedFurCounts& counts) const;

  /// The same for many rays at once. A ray that needs a page which is not resident waits while other rays
  /// continue. When the max number of rays or all rays wait, the thread reads the page for which the most
  /// rays wait, and these rays continue. As in single queries, every ray visits its treelets front to back
  /// or, for occlusion, the resident treelets first. `starts` must be empty or as long as `rays`; the answers
  /// are as long as `rays` and equal to the answers of single queries.
  void closest(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
               std::span<PagedFurHit> hits, PagedFurCounts& counts) const;
  void occluded(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                std::span<uint8_t> answers, PagedFurCounts& counts) const;

  const FurPageTable& table() const { return file_.table(); }
  /// Expansions are page reads.
  ResidencyCounts counts() const { return residency_->counts(); }
  uint64_t bytes_read() const;

 private:
  class Pages;
  template <class Query>
  class Batch;
  struct Nearest;
  struct Any;

  /// Traversal of the treelets' boxes by a ray.
  ChunkWalk walk(const Ray& ray, ChunkWalk::Order order) const;

  /// Tests one treelet for one ray, with its page pinned. False ends the ray.
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
