// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/paged_fur.h"

#include <algorithm>
#include <atomic>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/page_block.h"
#include "base/parallel.h"
#include "render/accel/flush_denormals.h"
#include "tests/render/accel/fur/fur_paging.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr size_t kStrands = 300;
constexpr uint64_t kRays = 500;  // fewer would make too few faults to compare

/// A page for each of `threads` and `share` of the rest.
PagedFurOptions budget(StoredGroom& groom, double share, int threads, size_t waiting_rays = 100) {
  PagedFurOptions options;
  options.threads = threads;
  options.waiting_rays = waiting_rays;
  options.poison = true;
  MemoryLedger ledger;
  const PagedFur idle(groom.open(), options, ledger, Workers::alone());  // holds what is always held
  const uint64_t pages = idle.table().page_bytes.size();
  const uint64_t frame = PageBlock::held_bytes(idle.table().largest_page()) + 128;
  const uint64_t own = std::min<uint64_t>(pages, static_cast<uint64_t>(threads));
  const auto others = static_cast<uint64_t>(share * static_cast<double>(pages - own));
  options.memory_limit = static_cast<uint64_t>(ledger.budgeted()) + frame * (own + others);
  return options;
}

struct Queries {
  std::vector<Ray> rays;
  std::vector<PagedFurStart> starts;
  std::vector<FurHit> closest;
  std::vector<uint8_t> occluded;
};

/// Rays at a groom, some of which start on a strand, and what the tree in memory answers.
Queries queries(const GroomShape& shape, const StoredGroom& groom) {
  const FlushDenormals flush;
  TestRandom random(8);
  Queries q;
  for (uint64_t i = 0; i < kRays; ++i) {
    Ray ray = ray_at_groom(shape, groom.strands, random, i);
    PagedFurStart start;
    const FurHit hit = groom.tree.closest(ray, {});
    if (i % 3 == 0 && hit) {
      ray.origin = ray.origin + hit.distance * ray.direction;
      ray.direction = random.direction();
      ray.near = 0;
      const SnappedStrands::Place place = groom.snapped.locate(hit.number);
      start.start = {groom.snapped.first_segment(place.strand), place.segment + 1,
                     static_cast<float>(place.segment) + hit.u};
    }
    q.rays.push_back(ray);
    q.starts.push_back(start);
    q.closest.push_back(groom.tree.closest(ray, start.start));
    q.occluded.push_back(groom.tree.occluded(ray, start.start));
  }
  return q;
}

/// Under a sanitizer those only that make pages of another kind; trees of all shapes are tested in memory.
std::vector<GroomShape> paged_shapes() {
  std::vector<GroomShape> shapes = groom_shapes();
  if (kSanitized) shapes = {shapes[0], shapes[6], shapes[9], shapes[11]};
  return shapes;
}

class PagedFurOf : public testing::TestWithParam<GroomShape> {};

INSTANTIATE_TEST_SUITE_P(Grooms, PagedFurOf, testing::ValuesIn(paged_shapes()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

struct Built {
  FurNodeLayout layout;
  FurRotation rotation;
};

TEST_P(PagedFurOf, answers_as_the_tree_in_memory) {
  for (const auto& [layout, rotation] : {Built{FurNodeLayout::kFloat, FurRotation::kNever},
                                         Built{FurNodeLayout::kQuantised, FurRotation::kWhenUseful},
                                         Built{FurNodeLayout::kQuantised, FurRotation::kAlways}}) {
    StoredGroom groom(GetParam(), kStrands, layout, rotation);
    const bool moves = GetParam().motion_keys > 1;
    const bool pays = rotation == FurRotation::kWhenUseful && GetParam().name == "combed";
    EXPECT_EQ(groom.tree.view().frame.turned, (rotation == FurRotation::kAlways && !moves) || pays);
    const Queries q = queries(GetParam(), groom);
    EXPECT_GT(std::count(q.occluded.begin(), q.occluded.end(), 1), ptrdiff_t(kRays / 50));
    for (const double share : {1.0, 0.25, 0.0}) {
      const FlushDenormals flush;
      MemoryLedger ledger;
      const PagedFurOptions options = budget(groom, share, 1);
      const PagedFur fur(groom.open(), options, ledger, Workers::alone());
      PagedFurCounts counts;
      for (size_t i = 0; i < kRays; ++i) {
        ASSERT_TRUE(same_hit(fur.closest(q.rays[i], q.starts[i], 0, counts).hit, q.closest[i])) << i;
        ASSERT_EQ(fur.occluded(q.rays[i], q.starts[i], 0, counts), q.occluded[i] != 0) << i;
      }
      EXPECT_LE(ledger.peak(MemoryTag::kChunks), static_cast<int64_t>(options.memory_limit));
      const ResidencyCounts pages = fur.counts();
      if (share == 1) {
        EXPECT_EQ(pages.reexpansions, 0);
      } else {
        EXPECT_GT(pages.evictions, 0);
      }
      EXPECT_EQ(pages.overruns, 0);
    }
  }
}

TEST_P(PagedFurOf, answers_many_rays_at_once_with_fewer_faults) {
  StoredGroom groom(GetParam(), kStrands, FurNodeLayout::kQuantised, FurRotation::kWhenUseful);
  const Queries q = queries(GetParam(), groom);
  const FlushDenormals flush;
  MemoryLedger ledger, other;
  const PagedFurOptions options = budget(groom, 0.1, 1);
  const PagedFur together(groom.open(), options, ledger, Workers::alone());
  const PagedFur alone(groom.open(), options, other, Workers::alone());
  PagedFurCounts counts, alone_counts;
  std::vector<PagedFurHit> hits(kRays);
  together.closest(q.rays, q.starts, 0, hits, counts);
  for (size_t i = 0; i < kRays; ++i) {
    ASSERT_TRUE(same_hit(hits[i].hit, q.closest[i])) << i;
    alone.closest(q.rays[i], q.starts[i], 0, alone_counts);
  }
  EXPECT_LE(counts.treelet_visits, alone_counts.treelet_visits);
  EXPECT_LT(together.counts().expansions, alone.counts().expansions);
  EXPECT_LE(ledger.peak(MemoryTag::kChunks), static_cast<int64_t>(options.memory_limit));
  std::vector<uint8_t> answers(kRays);
  together.occluded(q.rays, q.starts, 0, answers, counts);
  EXPECT_EQ(answers, q.occluded);
}

TEST_P(PagedFurOf, answers_alike_however_few_rays_may_wait) {
  StoredGroom groom(GetParam(), kStrands, FurNodeLayout::kQuantised, FurRotation::kAlways);
  const Queries q = queries(GetParam(), groom);
  const FlushDenormals flush;
  for (const size_t waiting_rays : {0, 1, 7, 10000}) {
    MemoryLedger ledger;
    const PagedFur fur(groom.open(), budget(groom, 0.1, 1, waiting_rays), ledger, Workers::alone());
    PagedFurCounts counts;
    // What is in the answers before does not matter.
    std::vector<PagedFurHit> hits(kRays, PagedFurHit{{0, 3, 0.5f, 0}, 1});
    std::vector<uint8_t> answers(kRays, 2);
    fur.closest(q.rays, q.starts, 0, hits, counts);
    fur.occluded(q.rays, q.starts, 0, answers, counts);
    for (size_t i = 0; i < kRays; ++i) ASSERT_TRUE(same_hit(hits[i].hit, q.closest[i])) << i;
    ASSERT_EQ(answers, q.occluded);
  }
}

TEST_P(PagedFurOf, holds_nothing_that_is_not_charged) {
  StoredGroom groom(GetParam(), kStrands, FurNodeLayout::kQuantised);
  const Queries q = queries(GetParam(), groom);
  const FlushDenormals flush;
  // As many as there are rays, so that what waits would be seen.
  const PagedFurOptions options = budget(groom, 0.1, 1, kRays);
  std::vector<PagedFurHit> hits(kRays);
  std::vector<uint8_t> answers(kRays);
  MemoryLedger ledger;
  FurPageFile file = groom.open();
  const size_t page = file.table().largest_page();
  const auto file_bytes = static_cast<int64_t>(file.bytes());
  const PagedFur fur(std::move(file), options, ledger, Workers::alone());
  const size_t before = live_bytes();
  reset_peak();
  PagedFurCounts counts;
  fur.closest(q.rays, q.starts, 0, hits, counts);
  fur.occluded(q.rays, q.starts, 0, answers, counts);
  EXPECT_GT(fur.counts().evictions, 0);
  // Everything but frames, which are aligned and do not come from where this is counted: what is held for
  // rays was there before.
  EXPECT_LT(peak_bytes() - before, page);
  const auto waiting = static_cast<int64_t>(WaitingRays::bytes(fur.table().page_bytes.size(), kRays));
  EXPECT_GE(waiting, static_cast<int64_t>(kRays * sizeof(WaitingRays::Ray)));
  EXPECT_GT(ledger.current(MemoryTag::kChunks), file_bytes + waiting);
  EXPECT_LE(ledger.peak(MemoryTag::kChunks), static_cast<int64_t>(options.memory_limit));
}

/// Two trees that are turned differently, and one that is not.
TEST(PagedFur, answers_of_trees_that_stand_along_different_axes) {
  const GroomShape shape = groom_shapes()[0], combed = groom_shapes()[11];
  const GroomShape* shapes[] = {&shape, &combed, &shape};
  TemporaryFolder folder;
  const ContentStore store(folder.path());
  FurWarnings warnings;
  FurPageFile::Writer writer(store, kFurKey, kSmallPages);
  std::vector<FurTree> trees;
  for (size_t i = 0; i < 3; ++i) {
    const Strands strands = random_groom(*shapes[i], 100, 40 + i);
    const SnappedStrands snapped(strands, FurGrid(shapes[i]->width, V3f(0, static_cast<float>(i), 1)));
    trees.emplace_back(
        snapped, fur_options(FurNodeLayout::kQuantised, i == 2 ? FurRotation::kNever : FurRotation::kAlways));
    writer.add(trees.back());
  }
  ASSERT_TRUE(writer.commit(warnings.sink()));
  MemoryLedger ledger;
  const PagedFur fur(FurPageFile::open(store, kFurKey, warnings.sink()).value(), {}, ledger,
                     Workers::alone());
  const FlushDenormals flush;
  const Strands aim = random_groom(shape, 100, 40);
  TestRandom random(9);
  PagedFurCounts counts;
  int met = 0;
  for (uint64_t i = 0; i < kRays; ++i) {
    const Ray ray = ray_at_groom(shape, aim, random, i);
    PagedFurHit truth;
    for (uint32_t t = 0; t < 3; ++t) {
      const PagedFurHit hit{trees[t].closest(ray, {}), t};
      if (hit && (!truth || hit.precedes(truth))) truth = hit;
    }
    const PagedFurHit hit = fur.closest(ray, {}, 0, counts);
    ASSERT_TRUE(same_hit(hit.hit, truth.hit)) << i;
    ASSERT_TRUE(!hit || hit.tree == truth.tree);
    ASSERT_EQ(fur.occluded(ray, {}, 0, counts), bool(truth));
    met += bool(hit);
  }
  EXPECT_GT(met, static_cast<int>(kRays / 10));
}

TEST(PagedFur, answers_alike_for_any_number_of_threads) {
  const GroomShape shape = groom_shapes()[11];
  StoredGroom groom(shape, kStrands, FurNodeLayout::kQuantised, FurRotation::kAlways);
  const Queries q = queries(shape, groom);
  for (const int threads : {2, 5}) {
    for (const double share : {0.5, 0.0}) {
      MemoryLedger ledger;
      const PagedFurOptions options = budget(groom, share, threads);
      const Workers workers(threads);
      const PagedFur fur(groom.open(), options, ledger, workers);
      std::atomic<int> wrong{0}, worker{0};
      // As many ranges as threads: each has a number of its own.
      const size_t grain = (kRays + static_cast<size_t>(threads) - 1) / static_cast<size_t>(threads);
      workers.for_each(kRays, grain, [&](WorkRange range) {
        const FlushDenormals flush;
        const int own = worker.fetch_add(1);
        PagedFurCounts counts;
        for (size_t i = range.begin; i < range.end; ++i) {
          const bool same = same_hit(fur.closest(q.rays[i], q.starts[i], own, counts).hit, q.closest[i]) &&
                            fur.occluded(q.rays[i], q.starts[i], own, counts) == (q.occluded[i] != 0);
          if (!same) ++wrong;
        }
        std::vector<PagedFurHit> hits(range.end - range.begin);
        fur.closest(std::span(q.rays).subspan(range.begin, hits.size()),
                    std::span(q.starts).subspan(range.begin, hits.size()), own, hits, counts);
        for (size_t i = 0; i < hits.size(); ++i) wrong += !same_hit(hits[i].hit, q.closest[range.begin + i]);
      });
      EXPECT_EQ(wrong, 0);
      EXPECT_LE(ledger.peak(MemoryTag::kChunks), static_cast<int64_t>(options.memory_limit));
    }
  }
}

// Each thread has a queue of its own: that another's is full makes no ray of this one go alone.
TEST(PagedFur, lets_rays_of_every_thread_wait) {
  const GroomShape shape = groom_shapes()[0];
  StoredGroom groom(shape, kStrands, FurNodeLayout::kQuantised, FurRotation::kNever);
  const Queries q = queries(shape, groom);
  constexpr int kThreads = 3;
  const auto faults = [&](size_t waiting_rays) {
    MemoryLedger ledger;
    PagedFurOptions options = budget(groom, 0.1, kThreads);
    options.waiting_rays = waiting_rays;
    const Workers workers(kThreads);
    const PagedFur fur(groom.open(), options, ledger, workers);
    std::atomic<int> worker{0};
    workers.for_each(kThreads, 1, [&](WorkRange) {
      const FlushDenormals flush;
      PagedFurCounts counts;
      std::vector<PagedFurHit> hits(q.rays.size());
      fur.closest(q.rays, q.starts, worker.fetch_add(1), hits, counts);
    });
    return fur.counts().expansions;
  };
  EXPECT_LT(2 * faults(16), faults(0));
}

TEST(PagedFur, refuses_a_budget_without_a_page_per_thread) {
  StoredGroom groom(groom_shapes()[0], kStrands, FurNodeLayout::kQuantised);
  MemoryLedger ledger;
  try {
    const PagedFur fur(groom.open(), {4, 1000}, ledger, Workers::alone());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
  }
}

TEST(PagedFur, reports_a_page_that_was_damaged_meanwhile) {
  const GroomShape shape = groom_shapes()[0];
  StoredGroom groom(shape, kStrands, FurNodeLayout::kQuantised);
  const Queries q = queries(shape, groom);
  MemoryLedger ledger;
  const PagedFur fur(groom.open(), {}, ledger, Workers::alone());
  {
    std::fstream file(groom.path(), std::ios::in | std::ios::out | std::ios::binary);
    for (int at = 100; at < 30000; at += 512) file.seekp(at).put('\x55');
  }
  const FlushDenormals flush;
  PagedFurCounts counts;
  EXPECT_THROW(for (const Ray& ray : q.rays) fur.closest(ray, {}, 0, counts), Error);
  // Rays that waited are forgotten.
  std::vector<PagedFurHit> hits(kRays);
  EXPECT_THROW(fur.closest(q.rays, {}, 0, hits, counts), Error);
  fur.closest(std::span<const Ray>(), {}, 0, {}, counts);
  EXPECT_THROW(fur.closest(q.rays, {}, 0, hits, counts), Error);
}

TEST(PagedFur, of_nothing_is_never_met) {
  TemporaryFolder folder;
  const ContentStore store(folder.path());
  FurWarnings warnings;
  FurPageFile::Writer writer(store, kFurKey);
  ASSERT_TRUE(writer.commit(warnings.sink()));
  MemoryLedger ledger;
  const PagedFur fur(FurPageFile::open(store, kFurKey, warnings.sink()).value(), {}, ledger,
                     Workers::alone());
  PagedFurCounts counts;
  EXPECT_FALSE(fur.closest(Ray(), {}, 0, counts));
  EXPECT_FALSE(fur.occluded(Ray(), {}, 0, counts));
  EXPECT_EQ(warnings.lines.size(), 0u);
}

}  // namespace
}  // namespace pelage
