// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/paged_fur.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>

#include "base/page_block.h"
#include "base/parallel.h"
#include "procedurals/chunk_bounds.h"
#include "render/accel/fur/paged_fur_query.h"

namespace pelage {
namespace {

constexpr size_t kMaxAbsent = 64;  // treelets of one ray whose pages are not resident

bool is_finite(const Ray& ray) {
  const float sum = ray.origin.x + ray.origin.y + ray.origin.z + ray.direction.x + ray.direction.y +
                    ray.direction.z + ray.near + ray.time;
  return std::isfinite(sum) && !std::isnan(ray.far);
}

/// The frame shared by all trees, or the scene's.
FurFrame frame_of(const FurPageTable& table) {
  if (table.treelets.empty()) return {};
  const FurFrame& frame = table.trees[table.treelets[0].tree].frame;
  const auto has_another = [&](const FurTreelet& t) { return !(table.trees[t.tree].frame == frame); };
  return std::any_of(table.treelets.begin(), table.treelets.end(), has_another) ? FurFrame() : frame;
}

Box3f unrotated(const FurFrame& frame, const Box3f& box) {
  const FurBox grid = frame.unrotated({{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}});
  return {V3f(grid.low[0], grid.low[1], grid.low[2]), V3f(grid.high[0], grid.high[1], grid.high[2])};
}

std::vector<ChunkBounds> treelet_bounds(const FurPageTable& table, const FurFrame& frame) {
  const auto keys = static_cast<size_t>(table.box_keys);
  std::vector<ChunkBounds> bounds(table.treelets.size());
  for (size_t i = 0; i < bounds.size(); ++i) {
    bounds[i].keys = table.box_keys;
    const FurFrame& own = table.trees[table.treelets[i].tree].frame;
    for (size_t key = 0; key < keys; ++key) {
      const Box3f& box = table.boxes[i * keys + key];
      bounds[i].boxes.push_back(own == frame ? box : unrotated(own, box));
    }
  }
  return bounds;
}

V3f turned(const FurFrame& frame, const V3f& v) {
  V3f result;
  for (size_t axis = 0; axis < 3; ++axis) {
    result[static_cast<int>(axis)] = static_cast<float>(V3d(frame.axes[axis]).dot(V3d(v)));
  }
  return result;
}

PagedFurStart start_of(std::span<const PagedFurStart> starts, size_t i) {
  return starts.empty() ? PagedFurStart() : starts[i];
}

size_t waiting_bytes(const FurPageTable& table, const PagedFurOptions& options) {
  return static_cast<size_t>(options.threads) *
         WaitingRays::bytes(table.page_bytes.size(), options.waiting_rays);
}

}  // namespace

/// Reads pages into buffers of equal size. Buffers of evicted pages are reused, so that a page needs no new
/// memory; at most one per thread is idle.
class PagedFur::Pages final : public Grower {
 public:
  Pages(const FurPageFile& file, const PagedFurOptions& options)
      : file_(file),
        frame_bytes_(file.table().largest_page()),
        max_idle_(static_cast<size_t>(options.threads)),
        poison_(options.poison) {}

  class Page final : public Resident {
   public:
    Page(Pages& pages, PageBlock frame) : pages_(pages), frame_(std::move(frame)) {}
    ~Page() override { pages_.release_block(std::move(frame_)); }
    const std::byte* data() const { return frame_.data(); }

   private:
    Pages& pages_;
    PageBlock frame_;
  };

  static size_t held_bytes(size_t page_bytes) { return PageBlock::held_bytes(page_bytes) + sizeof(Page); }
  size_t reserve_bytes(uint32_t) const override { return held_bytes(frame_bytes_); }
  Grown grow(uint32_t page) override {
    PageBlock frame = take();
    const uint32_t bytes = file_.table().page_bytes[page];
    file_.read(page, {frame.data(), bytes});
    bytes_read_.fetch_add(bytes, std::memory_order_relaxed);
    return {std::make_unique<Page>(*this, std::move(frame)), reserve_bytes(page)};
  }
  uint64_t bytes_read() const { return bytes_read_.load(std::memory_order_relaxed); }

 private:
  PageBlock take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        PageBlock frame = std::move(idle_.back());
        idle_.pop_back();
        return frame;
      }
    }
    return PageBlock(frame_bytes_);
  }
  void release_block(PageBlock frame) {
    if (poison_) std::memset(frame.data(), 0xdd, frame.bytes());
    const std::lock_guard lock(mutex_);
    if (idle_.size() < max_idle_) idle_.push_back(std::move(frame));
  }

  const FurPageFile& file_;
  const size_t frame_bytes_, max_idle_;
  const bool poison_;
  std::atomic<uint64_t> bytes_read_{0};
  std::mutex mutex_;
  std::vector<PageBlock> idle_;
};

PagedFur::PagedFur(FurPageFile file, const PagedFurOptions& options, MemoryLedger& ledger,
                   const Workers& workers)
    : file_(std::move(file)),
      waiting_rays_(options.waiting_rays),
      frame_(frame_of(file_.table())),
      tree_(std::make_unique<ChunkTree>(treelet_bounds(file_.table(), frame_), workers)),
      fixed_bytes_(file_.bytes() + tree_->bytes() + waiting_bytes(file_.table(), options)),
      charge_(ledger, MemoryTag::kChunks, static_cast<int64_t>(fixed_bytes_)),
      pages_(std::make_unique<Pages>(file_, options)),
      residency_(std::make_unique<Residency>(*pages_, table().page_bytes.size(), options.threads,
                                             MemoryBudget{options.memory_limit}, ledger,
                                             MemoryTag::kChunks)) {
  for (int thread = 0; thread < options.threads; ++thread) {
    waiting_.emplace_back(table().page_bytes.size(), options.waiting_rays);
  }
}

PagedFur::~PagedFur() = default;

uint64_t PagedFur::bytes_for(const FurPageFile& file, double share, const PagedFurOptions& options,
                             const Workers& workers) {
  const FurPageTable& table = file.table();
  const size_t pages = table.page_bytes.size();
  const size_t index = Residency::index_bytes(pages, options.threads);
  const auto frames = static_cast<size_t>(std::ceil(share * static_cast<double>(pages)));
  return file.bytes() + ChunkTree(treelet_bounds(table, frame_of(table)), workers).bytes() +
         waiting_bytes(table, options) + index + frames * Pages::held_bytes(table.largest_page());
}

uint64_t PagedFur::bytes_read() const { return pages_->bytes_read(); }

ChunkWalk PagedFur::walk(const Ray& ray, ChunkWalk::Order order) const {
  if (!frame_.turned) return {*tree_, ray, order};
  // Rotated in double precision: this adds one sixteenth to the error that boxes allow for.
  Ray here = ray;
  here.origin = turned(frame_, ray.origin);
  here.direction = turned(frame_, ray.direction);
  return {*tree_, here, order};
}

template <class Query>
bool PagedFur::visit(uint32_t treelet, Query& query, int thread, PagedFurCounts& counts) const {
  ++counts.treelet_visits;
  FurTests* tests = counts.count_tests ? &counts.tests : nullptr;
  const FurTreelet& t = table().treelets[treelet];
  return residency_->visit(t.page, thread, [&](Resident& unit) {
    const auto* page = static_cast<const Pages::Page&>(unit).data();
    return query.test(treelet_view(table().trees[t.tree], t, page), t.tree, tests);
  });
}

PagedFurHit PagedFur::closest(const Ray& ray, const PagedFurStart& start, int thread,
                              PagedFurCounts& counts) const {
  PagedFurHit best;
  if (!is_finite(ray)) return best;
  Nearest query(ray, start, best);
  ChunkWalk way = walk(ray, Nearest::kOrder);
  uint32_t treelet = 0;
  float entry = 0;
  while (way.next(query.far(), treelet, entry)) {
    visit(treelet, query, thread, counts);
  }
  counts.box_tests += way.box_tests();
  return best;
}

bool PagedFur::occluded(const Ray& ray, const PagedFurStart& start, int thread,
                        PagedFurCounts& counts) const {
  uint8_t hit = 0;
  if (!is_finite(ray)) return false;
  Any query(ray, start, hit);
  ChunkWalk way = walk(ray, Any::kOrder);
  uint32_t absent[kMaxAbsent];
  size_t count = 0;
  uint32_t treelet = 0;
  float entry = 0;
  while (!hit && way.next(query.far(), treelet, entry)) {
    if (count < kMaxAbsent && !is_resident(treelet)) {
      absent[count++] = treelet;
      continue;
    }
    visit(treelet, query, thread, counts);
  }
  for (size_t i = 0; i < count && !hit; ++i) visit(absent[i], query, thread, counts);
  counts.box_tests += way.box_tests();
  return hit != 0;
}

/// Traces many rays of one thread.
template <class Query>
class PagedFur::Batch {
 public:
  using Answer = typename Query::Answer;

  Batch(const PagedFur& fur, std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
        std::span<Answer> answers, PagedFurCounts& counts)
      : fur_(fur),
        rays_(rays),
        starts_(starts),
        answers_(answers),
        thread_(thread),
        counts_(counts),
        waiting_(fur.waiting_[static_cast<size_t>(thread)]) {}

  void run() {
    try {
      size_t ray = 0;
      std::optional<uint32_t> page;
      while (true) {
        while (ray < rays_.size() && !waiting_.is_full()) set_out(ray++);
        if (waiting_.is_empty()) return;
        if (!page) page = waiting_.fullest();
        uint32_t slot = waiting_.release(*page);
        for (bool is_read = false; slot != WaitingRays::kNone; is_read = true) {
          const uint32_t after = waiting_[slot].next;
          advance(slot);
          if (!is_read) page = expect_next();
          slot = after;
        }
      }
    } catch (...) {
      waiting_.clear();
      throw;
    }
  }

 private:
  using UpcomingSteps = WaitingRays::UpcomingSteps;
  using Step = WaitingRays::Step;

  Query query(size_t i) { return {rays_[i], start_of(starts_, i), answers_[i]}; }
  bool is_resident(uint32_t treelet) const { return fur_.is_resident(treelet); }

  /// The page after this one, which the system loads while rays traverse this one.
  std::optional<uint32_t> expect_next() const {
    if (waiting_.is_empty()) return {};
    const uint32_t page = waiting_.fullest();
    if (!fur_.residency_->is_resident(page)) fur_.file_.prefetch(page);
    return page;
  }

  /// Starts a ray: traverses the resident treelets, as for a single ray. At the first treelet that is not
  /// resident, stores the remaining steps and waits.
  void set_out(size_t i) {
    answers_[i] = {};
    if (!is_finite(rays_[i])) return;
    Query asks = query(i);
    UpcomingSteps upcoming;
    if (!look(asks, upcoming, [&](const Step& step) {
          if (Query::kNearestFirst && !upcoming.is_empty()) return true;
          return !is_resident(step.treelet);
        }))
      return;
    if (upcoming.is_empty()) return;
    const uint32_t slot = waiting_.begin();
    WaitingRays::Ray& ray = waiting_[slot];
    ray.number = static_cast<uint32_t>(i);
    ray.is_complete = !upcoming.is_full();
    ray.upcoming = upcoming;
    wait(slot);
  }

  /// Visits the treelets that a ray intersects. Those selected by `is_for_later` are added to `upcoming`
  /// while there is space, the others are visited. False when the ray is finished.
  template <class IsForLater>
  bool look(Query& asks, UpcomingSteps& upcoming, const IsForLater& is_for_later) {
    ChunkWalk way = fur_.walk(asks.ray, Query::kOrder);
    Step step;
    bool open = true;
    while (open) {
      // With a full list, later treelets in order would not be kept.
      const bool no_farther = Query::kNearestFirst && upcoming.is_full();
      const float far = no_farther ? std::min(asks.far(), upcoming.back().entry) : asks.far();
      if (!way.next(far, step.treelet, step.entry)) break;
      if (is_for_later(step)) {
        upcoming.add(step);
      } else {
        open = fur_.visit(step.treelet, asks, thread_, counts_);
      }
    }
    counts_.box_tests += way.box_tests();
    return open;
  }

  void wait(uint32_t slot) {
    waiting_.wait(slot, fur_.table().treelets[waiting_[slot].upcoming.front().treelet].page);
  }

  /// Reads the page that the ray waits for, if necessary, and traverses everything resident.
  void advance(uint32_t slot) {
    WaitingRays::Ray& ray = waiting_[slot];
    Query asks = query(ray.number);
    const auto resident = [&](uint32_t treelet) { return is_resident(treelet); };
    do {
      const uint32_t treelet = ray.upcoming.front().treelet;
      ray.upcoming.pop();
      if (!fur_.visit(treelet, asks, thread_, counts_)) break;
      if (ray.upcoming.is_empty() && !find_next(ray, asks)) break;
      // For occlusion, the order does not matter.
      if (!Query::kNearestFirst) ray.upcoming.bring_forward(resident);
      if (ray.upcoming.front().entry > asks.far()) break;
      if (!is_resident(ray.upcoming.front().treelet)) return wait(slot);
    } while (true);
    waiting_.end(slot);
  }

  /// Finds the steps after all that were upcoming. False if there are none.
  bool find_next(WaitingRays::Ray& ray, Query& asks) {
    if (ray.is_complete) return false;
    const Step last = ray.upcoming.last();
    ray.upcoming.clear();
    ChunkWalk way = fur_.walk(asks.ray, Query::kOrder);
    Step step;
    while (way.next(ray.upcoming.is_full() ? std::min(asks.far(), ray.upcoming.back().entry) : asks.far(),
                    step.treelet, step.entry)) {
      if (last < step) ray.upcoming.add(step);
    }
    counts_.box_tests += way.box_tests();
    ray.is_complete = !ray.upcoming.is_full();
    return !ray.upcoming.is_empty();
  }

  const PagedFur& fur_;
  const std::span<const Ray> rays_;
  const std::span<const PagedFurStart> starts_;
  const std::span<Answer> answers_;
  const int thread_;
  PagedFurCounts& counts_;
  WaitingRays& waiting_;
};

void PagedFur::closest(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                       std::span<PagedFurHit> hits, PagedFurCounts& counts) const {
  if (!rays_may_wait()) {
    for (size_t i = 0; i < rays.size(); ++i) hits[i] = closest(rays[i], start_of(starts, i), thread, counts);
    return;
  }
  Batch<Nearest>(*this, rays, starts, thread, hits, counts).run();
}

void PagedFur::occluded(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                        std::span<uint8_t> answers, PagedFurCounts& counts) const {
  if (!rays_may_wait()) {
    for (size_t i = 0; i < rays.size(); ++i)
      answers[i] = occluded(rays[i], start_of(starts, i), thread, counts) ? 1 : 0;
    return;
  }
  Batch<Any>(*this, rays, starts, thread, answers, counts).run();
}

}  // namespace pelage
