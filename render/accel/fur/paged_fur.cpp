// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/paged_fur.h"

#include <atomic>
#include <cstring>
#include <mutex>
#include <tuple>

#include "base/page_block.h"
#include "base/parallel.h"
#include "procedurals/chunk_bounds.h"
#include "render/accel/fur/paged_fur_query.h"

namespace pelage {
namespace {

constexpr size_t kMostWaiting = 64;  // treelets of one ray whose pages are not resident

bool is_finite(const Ray& ray) {
  const float sum = ray.origin.x + ray.origin.y + ray.origin.z + ray.direction.x + ray.direction.y +
                    ray.direction.z + ray.near + ray.time;
  return std::isfinite(sum) && !std::isnan(ray.far);
}

std::vector<ChunkBounds> treelet_bounds(const FurPageTable& table) {
  const auto keys = static_cast<size_t>(table.box_keys);
  std::vector<ChunkBounds> bounds(table.treelets.size());
  for (size_t i = 0; i < bounds.size(); ++i) {
    bounds[i].keys = table.box_keys;
    const auto first = table.boxes.begin() + static_cast<std::ptrdiff_t>(i * keys);
    bounds[i].boxes.assign(first, first + static_cast<std::ptrdiff_t>(keys));
  }
  return bounds;
}

}  // namespace

/// Reads pages into frames of equal size. Frames of dropped pages are used again, so that a page costs no
/// new memory; at most one per thread lies idle.
class PagedFur::Pages final : public Grower {
 public:
  Pages(const FurPageFile& file, const PagedFurOptions& options)
      : file_(file),
        frame_bytes_(file.table().largest_page()),
        most_idle_(static_cast<size_t>(options.threads)),
        poison_(options.poison) {}

  class Page final : public Resident {
   public:
    Page(Pages& pages, PageBlock frame) : pages_(pages), frame_(std::move(frame)) {}
    ~Page() override { pages_.give_back(std::move(frame_)); }
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
  void give_back(PageBlock frame) {
    if (poison_) std::memset(frame.data(), 0xdd, frame.bytes());
    const std::lock_guard lock(mutex_);
    if (idle_.size() < most_idle_) idle_.push_back(std::move(frame));
  }

  const FurPageFile& file_;
  const size_t frame_bytes_, most_idle_;
  const bool poison_;
  std::atomic<uint64_t> bytes_read_{0};
  std::mutex mutex_;
  std::vector<PageBlock> idle_;
};

PagedFur::PagedFur(FurPageFile file, const PagedFurOptions& options, MemoryLedger& ledger,
                   const Workers& workers)
    : file_(std::move(file)),
      tree_(std::make_unique<ChunkTree>(treelet_bounds(file_.table()), workers)),
      fixed_bytes_(file_.bytes() + tree_->bytes()),
      charge_(ledger, MemoryTag::kChunks, static_cast<int64_t>(fixed_bytes_)),
      pages_(std::make_unique<Pages>(file_, options)),
      residency_(std::make_unique<Residency>(*pages_, table().page_bytes.size(), options.threads,
                                             MemoryBudget{options.memory_limit}, ledger,
                                             MemoryTag::kChunks)) {}

PagedFur::~PagedFur() = default;

uint64_t PagedFur::bytes_for(const FurPageFile& file, double share, const Workers& workers) {
  const size_t pages = file.table().page_bytes.size();
  const size_t index = Residency::index_bytes(pages, workers.thread_count());
  const auto frames = static_cast<size_t>(std::ceil(share * static_cast<double>(pages)));
  return file.bytes() + ChunkTree(treelet_bounds(file.table()), workers).bytes() + index +
         frames * Pages::held_bytes(file.table().largest_page());
}

uint64_t PagedFur::bytes_read() const { return pages_->bytes_read(); }

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
  if (!is_finite(ray)) return {};
  Nearest query(ray, start);
  ChunkWalk walk(*tree_, ray, Nearest::kOrder);
  uint32_t treelet = 0;
  float entry = 0;
  while (walk.next(query.far(), treelet, entry)) {
    visit(treelet, query, thread, counts);
  }
  counts.box_tests += walk.box_tests();
  return query.best;
}

bool PagedFur::occluded(const Ray& ray, const PagedFurStart& start, int thread,
                        PagedFurCounts& counts) const {
  if (!is_finite(ray)) return false;
  Any query(ray, start);
  ChunkWalk walk(*tree_, ray, Any::kOrder);
  uint32_t waiting[kMostWaiting];
  size_t waits = 0;
  uint32_t treelet = 0;
  float entry = 0;
  while (!query.hit && walk.next(query.far(), treelet, entry)) {
    if (waits < kMostWaiting && !is_resident(treelet)) {
      waiting[waits++] = treelet;
      continue;
    }
    visit(treelet, query, thread, counts);
  }
  for (size_t i = 0; i < waits && !query.hit; ++i) visit(waiting[i], query, thread, counts);
  counts.box_tests += walk.box_tests();
  return query.hit;
}

/// Rays that wait for pages. Of each ray the treelets that it may meet are known from the beginning, front to
/// back or in the order that suits it.
class PagedFur::Batch {
 public:
  Batch(const PagedFur& fur, int thread, PagedFurCounts& counts)
      : fur_(fur), thread_(thread), counts_(counts), waiting_(fur.table().page_bytes.size()) {}

  template <class Query>
  void run(std::vector<Query>& queries) {
    plans_.resize(queries.size());
    for (uint32_t i = 0; i < queries.size(); ++i) {
      plan(queries[i], i);
      go_on(queries[i], i);
    }
    // In rounds: all pages for which rays wait, those first that are resident meanwhile, then the ones that
    // most rays wait for. Rays that go on join the queues of pages to come.
    std::vector<Turn> round;
    while (!pages_.empty()) {
      round.clear();
      // Looked at once each: other threads read and drop pages meanwhile, and an order must not change while
      // it is sorted by.
      for (const uint32_t page : pages_) {
        round.emplace_back(!fur_.residency_->is_resident(page), ~waiting_[page].size(), page);
      }
      pages_.clear();
      std::sort(round.begin(), round.end());
      for (const auto& [absent, fewness, page] : round) {
        std::vector<uint32_t> rays;
        rays.swap(waiting_[page]);
        for (const uint32_t ray : rays) {
          visit_next(queries[ray], ray);
          go_on(queries[ray], ray);
        }
      }
    }
  }

 private:
  using Turn = std::tuple<bool, size_t, uint32_t>;  // not resident, the less the more wait, page
  struct Step {
    float entry;
    uint32_t treelet;
  };
  struct Plan {
    uint32_t next = 0, end = 0;  // in steps_
    bool done = false;
  };

  template <class Query>
  void plan(const Query& query, uint32_t i) {
    Plan& plan = plans_[i];
    plan.next = plan.end = static_cast<uint32_t>(steps_.size());
    if (!is_finite(query.ray)) return;
    ChunkWalk walk(*fur_.tree_, query.ray, Query::kOrder);
    Step step{};
    while (walk.next(query.far(), step.treelet, step.entry)) steps_.push_back(step);
    counts_.box_tests += walk.box_tests();
    plan.end = static_cast<uint32_t>(steps_.size());
    if (Query::kNearestFirst) {
      std::sort(steps_.begin() + plan.next, steps_.end(), [](const Step& a, const Step& b) {
        return a.entry != b.entry ? a.entry < b.entry : a.treelet < b.treelet;
      });
    }
  }

  template <class Query>
  void visit_next(Query& query, uint32_t i) {
    Plan& plan = plans_[i];
    const Step& step = steps_[plan.next++];
    if (step.entry > query.far()) {
      plan.next = plan.end;
      return;
    }
    if (!fur_.visit(step.treelet, query, thread_, counts_)) plan.next = plan.end;
  }

  /// Through all that is resident; then the ray waits.
  template <class Query>
  void go_on(Query& query, uint32_t i) {
    Plan& plan = plans_[i];
    while (plan.next < plan.end) {
      // What only has to be met may be met anywhere: what is resident comes first.
      if (!Query::kNearestFirst) bring_resident_forward(plan);
      if (steps_[plan.next].entry > query.far()) return;
      const uint32_t treelet = steps_[plan.next].treelet;
      if (!fur_.is_resident(treelet)) {
        const uint32_t page = fur_.table().treelets[treelet].page;
        if (waiting_[page].empty()) pages_.push_back(page);
        waiting_[page].push_back(i);
        return;
      }
      visit_next(query, i);
    }
  }

  void bring_resident_forward(const Plan& plan) {
    for (uint32_t k = plan.next; k < plan.end; ++k) {
      if (!fur_.is_resident(steps_[k].treelet)) continue;
      std::swap(steps_[k], steps_[plan.next]);
      return;
    }
  }

  const PagedFur& fur_;
  const int thread_;
  PagedFurCounts& counts_;
  std::vector<Plan> plans_;
  std::vector<Step> steps_;
  std::vector<std::vector<uint32_t>> waiting_;  // rays, by page
  std::vector<uint32_t> pages_;                 // that rays wait for, each once
};

namespace {

PagedFurStart start_of(std::span<const PagedFurStart> starts, size_t i) {
  return starts.empty() ? PagedFurStart() : starts[i];
}

}  // namespace

void PagedFur::closest(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                       std::span<PagedFurHit> hits, PagedFurCounts& counts) const {
  std::vector<Nearest> queries;
  queries.reserve(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) queries.emplace_back(rays[i], start_of(starts, i));
  Batch(*this, thread, counts).run(queries);
  for (size_t i = 0; i < rays.size(); ++i) hits[i] = queries[i].best;
}

void PagedFur::occluded(std::span<const Ray> rays, std::span<const PagedFurStart> starts, int thread,
                        std::span<uint8_t> answers, PagedFurCounts& counts) const {
  std::vector<Any> queries;
  queries.reserve(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) queries.emplace_back(rays[i], start_of(starts, i));
  Batch(*this, thread, counts).run(queries);
  for (size_t i = 0; i < rays.size(); ++i) answers[i] = queries[i].hit ? 1 : 0;
}

}  // namespace pelage
