// SPDX-License-Identifier: Apache-2.0
#include "lab/rays/lab_tracer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/ledger.h"
#include "base/nearest_name.h"
#include "base/parallel.h"
#include "base/process_usage.h"
#include "base/stopwatch.h"
#include "render/accel/embree_fur.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/fur/paged_fur.h"

namespace pelage {
namespace {

constexpr int kPasses = 2, kPagedPasses = 1;  // timed passes, after one warm-up pass
constexpr size_t kGrain = 1024;               // rays
constexpr uint64_t kWaitingShare = 4;         // waiting rays use this fraction of a budget
constexpr int kTessellationRate = 8;          // as in the renderer

/// Sums of one range.
struct Sums {
  uint64_t hits = 0, answers = 0;
  FurTests tests;

  void add(const FurHit& hit, uint64_t ray) {
    if (!hit) return;
    ++hits;
    answers += hash64(ray, hit.number, std::bit_cast<uint32_t>(hit.distance), std::bit_cast<uint32_t>(hit.u),
                      std::bit_cast<uint32_t>(hit.h));
  }
  void add(bool hit, uint64_t ray) {
    hits += hit;
    answers += hit ? hash64(ray) : 0;
  }
};

/// Calls trace(range, sums) for all rays.
template <class Trace>
Sums trace_all(const Workers& workers, size_t count, size_t grain, const Trace& trace) {
  std::vector<Sums> of_worker(static_cast<size_t>(workers.thread_count()));
  workers.for_each(count, grain, [&](WorkRange range) {
    const FlushDenormals flush;
    Sums sums;
    trace(range, sums);
    Sums& all = of_worker[static_cast<size_t>(range.worker)];
    all.hits += sums.hits, all.answers += sums.answers, all.tests += sums.tests;
  });
  Sums all;
  for (const Sums& sums : of_worker) {
    all.hits += sums.hits, all.answers += sums.answers, all.tests += sums.tests;
  }
  return all;
}

template <class Trace, class Meter>
LabCost cost_of(const LabRays& set, const Workers& workers, size_t grain, const Trace& trace,
                const Meter& meter, int passes) {
  LabCost best;
  best.wall_s = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass <= passes; ++pass) {
    const auto before = meter();
    const double cpu = cpu_seconds();
    const Stopwatch watch;
    const Sums sums = trace_all(workers, set.size(), grain, trace);
    LabCost cost;
    cost.wall_s = watch.seconds();
    cost.cpu_s = cpu_seconds() - cpu;
    cost.rays = static_cast<double>(set.size());
    cost.hits = static_cast<double>(sums.hits);
    cost.answers = static_cast<double>(sums.answers >> 12);
    const auto after = meter();
    cost.page_faults = static_cast<double>(after.first - before.first);
    cost.bytes_read = static_cast<double>(after.second - before.second);
    if (pass > 0 && cost.wall_s < best.wall_s) best = cost;
  }
  return best;
}

std::pair<int64_t, uint64_t> no_reads() { return {0, 0}; }

LabResult trace_embree(const LabFur& fur, const std::vector<LabRays>& sets, bool compact,
                       const Workers& workers) {
  LabResult result;
  MemoryLedger ledger;
  const double start = cpu_seconds();
  const EmbreeFur tree(fur.strands, compact, kTessellationRate, ledger, workers);
  result.build_cpu_s = cpu_seconds() - start;
  result.bytes = result.resident_bytes = static_cast<double>(ledger.current(MemoryTag::kChunks));
  for (const LabRays& set : sets) {
    result.rays[set.name] = cost_of(
        set, workers, kGrain,
        [&](const WorkRange& range, Sums& sums) {
          for (size_t i = range.begin; i < range.end; ++i) {
            Ray ray = set.rays[i];
            ray.near = set.clear[i];
            sums.hits += set.shadow ? tree.occluded(ray) : std::isfinite(tree.closest(ray));
          }
        },
        no_reads, kPasses);
    result.rays[set.name].answers = 0;
  }
  return result;
}

LabResult trace_fur(const LabFur& fur, const std::vector<LabRays>& sets, FurNodeLayout layout,
                    const Workers& workers) {
  LabResult result;
  const double start = cpu_seconds();
  const SnappedStrands snapped(fur.strands, fur.grid());
  FurTreeOptions options;
  options.layout = layout;
  options.build.rotation = FurRotation::kWhenUseful;  // as in renders
  const FurTree tree(snapped, options);
  result.build_cpu_s = cpu_seconds() - start;
  result.bytes = result.resident_bytes = static_cast<double>(tree.bytes());
  for (const LabRays& set : sets) {
    LabCost cost = cost_of(
        set, workers, kGrain,
        [&](const WorkRange& range, Sums& sums) {
          for (size_t i = range.begin; i < range.end; ++i) {
            if (set.shadow) {
              sums.add(tree.occluded(set.rays[i], set.starts[i]), i);
            } else {
              sums.add(tree.closest(set.rays[i], set.starts[i]), i);
            }
          }
        },
        no_reads, kPasses);
    const Sums counted = trace_all(workers, set.size(), kGrain, [&](const WorkRange& range, Sums& sums) {
      for (size_t i = range.begin; i < range.end; ++i) {
        if (set.shadow) {
          fur_occludes(tree.view(), set.rays[i], set.starts[i], nullptr, &sums.tests);
        } else {
          closest_fur(tree.view(), set.rays[i], set.starts[i], nullptr, &sums.tests);
        }
      }
    });
    cost.box_tests = static_cast<double>(counted.tests.boxes);
    cost.segment_tests = static_cast<double>(counted.tests.segments);
    result.rays[set.name] = cost;
  }
  return result;
}

void trace_alone(const PagedFur& fur, const LabRays& set, const WorkRange& range, bool count, Sums& sums) {
  PagedFurCounts counts;
  counts.count_tests = count;
  for (size_t i = range.begin; i < range.end; ++i) {
    const PagedFurStart start{set.starts[i], 0};
    if (set.shadow) {
      sums.add(fur.occluded(set.rays[i], start, range.worker, counts), i);
    } else {
      sums.add(fur.closest(set.rays[i], start, range.worker, counts).hit, i);
    }
  }
  sums.tests += counts.tests;
  sums.tests.boxes += counts.box_tests;
}

void trace_together(const PagedFur& fur, const LabRays& set, const WorkRange& range, Sums& sums) {
  PagedFurCounts counts;
  const size_t count = range.end - range.begin;
  const auto rays = std::span(set.rays).subspan(range.begin, count);
  std::vector<PagedFurStart> starts;
  for (size_t i = range.begin; i < range.end; ++i) starts.push_back({set.starts[i], 0});
  if (set.shadow) {
    std::vector<uint8_t> answers(count);
    fur.occluded(rays, starts, range.worker, answers, counts);
    for (size_t i = 0; i < count; ++i) sums.add(answers[i] != 0, range.begin + i);
  } else {
    std::vector<PagedFurHit> hits(count);
    fur.closest(rays, starts, range.worker, hits, counts);
    for (size_t i = 0; i < count; ++i) sums.add(hits[i].hit, range.begin + i);
  }
}

/// `share` of the tree's size covers all memory.
PagedFurOptions paged_options(const FurPageFile& file, double share, const Workers& workers) {
  PagedFurOptions options;
  options.threads = workers.thread_count();
  if (share >= 1) {
    options.memory_limit = PagedFur::bytes_for(file, 1, options, workers);
    return options;
  }
  options.memory_limit = static_cast<uint64_t>(share * static_cast<double>(file.table().total_page_bytes()));
  const uint64_t waiting = options.memory_limit / kWaitingShare / static_cast<uint64_t>(options.threads);
  options.waiting_rays = std::min<size_t>(options.waiting_rays, waiting / sizeof(WaitingRays::Ray));
  return options;
}

LabResult trace_paged(const ContentStore& store, const std::vector<LabRays>& sets, double share,
                      const Workers& workers) {
  auto file = FurPageFile::open(store, kLabKey,
                                [](const std::string& line) { throw Error(ErrorKind::kFailed, line); });
  if (!file) throw Error(ErrorKind::kFailed, store.folder().string() + ": no prepared pages found here");
  LabResult result;
  result.bytes = static_cast<double>(file->table().total_page_bytes());
  const PagedFurOptions options = paged_options(*file, share, workers);
  result.limit_bytes = static_cast<double>(options.memory_limit);
  MemoryLedger ledger;
  const double start = cpu_seconds();
  const PagedFur fur(std::move(*file), options, ledger, workers);
  result.build_cpu_s = cpu_seconds() - start;
  const auto meter = [&] { return std::pair(fur.counts().expansions, fur.bytes_read()); };
  for (const LabRays& set : sets) {
    // Each thread gets one contiguous range.
    const size_t stretch = set.size() / static_cast<size_t>(options.threads) + 1;
    LabCost& alone = result.rays[set.name] = cost_of(
        set, workers, kGrain,
        [&](const WorkRange& range, Sums& sums) { trace_alone(fur, set, range, false, sums); }, meter,
        kPagedPasses);
    if (share >= 1) {
      const FurTests tests = trace_all(workers, set.size(), kGrain, [&](const WorkRange& range, Sums& sums) {
                               trace_alone(fur, set, range, true, sums);
                             }).tests;
      alone.box_tests = static_cast<double>(tests.boxes);
      alone.segment_tests = static_cast<double>(tests.segments);
    }
    result.rays[set.name + "_together"] = cost_of(
        set, workers, stretch,
        [&](const WorkRange& range, Sums& sums) { trace_together(fur, set, range, sums); }, meter,
        kPagedPasses);
  }
  result.resident_bytes = static_cast<double>(ledger.peak(MemoryTag::kChunks));
  return result;
}

}  // namespace

const std::vector<std::string>& LabVariant::names() {
  static const std::vector<std::string> names{"prepare", "embree-fast", "embree-compact",
                                              "fur-128", "fur-64",      "paged"};
  return names;
}

LabVariant::Kind LabVariant::parse(const std::string& name) {
  const auto found = std::find(names().begin(), names().end(), name);
  if (found == names().end())
    throw Error(ErrorKind::kArguments, "unknown variant '" + name + "'" + did_you_mean(name, names()));
  return static_cast<Kind>(found - names().begin());
}

namespace {

std::vector<LabRays> rays_of(const ContentStore& store, const std::vector<std::string>& kinds) {
  std::vector<LabRays> sets = load_lab_rays(store);
  if (kinds.empty()) return sets;
  std::vector<LabRays> chosen;
  std::vector<std::string> names;
  for (const LabRays& set : sets) names.push_back(set.name);
  for (const std::string& kind : kinds) {
    const auto found = std::find(names.begin(), names.end(), kind);
    if (found == names.end())
      throw Error(ErrorKind::kArguments, "unknown ray kind '" + kind + "'" + did_you_mean(kind, names));
    chosen.push_back(std::move(sets[static_cast<size_t>(found - names.begin())]));
  }
  return chosen;
}

}  // namespace

LabResult trace_lab_rays(const LabVariant& variant, const ContentStore& store, const Job& job) {
  const std::vector<LabRays> sets = rays_of(store, variant.kinds);
  // Pages contain everything that paged fur needs.
  const LabFur fur = variant.kind == LabVariant::Kind::kPaged ? LabFur() : load_lab_fur(store);
  job.progress.begin("trace", 1);
  LabResult result;
  switch (variant.kind) {
    case LabVariant::Kind::kEmbreeFast:
    case LabVariant::Kind::kEmbreeCompact:
      result = trace_embree(fur, sets, variant.kind == LabVariant::Kind::kEmbreeCompact, job.workers);
      break;
    case LabVariant::Kind::kFur128:
    case LabVariant::Kind::kFur64:
      result = trace_fur(
          fur, sets,
          variant.kind == LabVariant::Kind::kFur128 ? FurNodeLayout::kFloat : FurNodeLayout::kQuantised,
          job.workers);
      break;
    case LabVariant::Kind::kPaged:
      result = trace_paged(store, sets, variant.share, job.workers);
      break;
    case LabVariant::Kind::kPrepare:
      break;
  }
  job.progress.end();
  result.segments = static_cast<double>(fur.segment_count());
  return result;
}

LabResult prepare_lab(const RenderScene& scene, const ContentStore& store, size_t max_rays, const Job& job) {
  const LabFur fur = grow_lab_fur(scene, job);
  store_lab_fur(store, fur);
  const SnappedStrands snapped(fur.strands, fur.grid());
  const double start = cpu_seconds();
  FurTreeOptions options;
  options.build.rotation = FurRotation::kWhenUseful;  // as in renders
  const FurTree tree(snapped, options);
  store_lab_rays(store, make_lab_rays(scene, fur.strands, snapped, tree, max_rays));
  LabResult result;
  result.segments = static_cast<double>(fur.segment_count());
  result.bytes = static_cast<double>(tree.bytes());
  FurPageFile::Writer pages(store, kLabKey);
  pages.add(tree);
  pages.commit([](const std::string& line) { throw Error(ErrorKind::kFailed, line); });
  result.build_cpu_s = cpu_seconds() - start;
  return result;
}

}  // namespace pelage
