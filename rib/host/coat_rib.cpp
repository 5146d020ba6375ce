// SPDX-License-Identifier: Apache-2.0
#include "rib/host/coat_rib.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/file.h"
#include "base/memory_budget.h"
#include "base/progress.h"
#include "rib/syntax/rib_curves.h"

namespace pelage {
namespace {

constexpr const char* kPlugin = "libpelage_ri.so";

/// Number of leaves from `first` on that fit into memory together: at least one, at most `max`.
size_t leaves_at_once(const CoatTree& tree, size_t first, size_t max, const MemoryLedger& ledger) {
  int64_t bytes = 0;
  size_t count = 0;
  while (count < max && first + count < tree.all().end) {
    bytes += tree.growth_bytes(first + count);
    if (count > 0 && !has_room(ledger, bytes)) break;
    ++count;
  }
  return count;
}

}  // namespace

void for_each_leaf(const CoatTree& tree, const Job& job,
                   const std::function<void(size_t leaf, const Strands& strands)>& use) {
  const auto threads = static_cast<size_t>(job.workers.thread_count());
  const ProgressStage stage(job.progress, "write", static_cast<double>(tree.all().end));
  for (size_t first = 0; first < tree.all().end;) {
    job.check_stop();
    const size_t count = leaves_at_once(tree, first, threads, job.ledger);
    int64_t bytes = 0;
    for (size_t i = 0; i < count; ++i) bytes += tree.growth_bytes(first + i);
    const MemoryCharge charge =
        reserve(job.ledger, MemoryTag::kChunks, bytes, "growing a leaf of a coat for the RIB file");
    std::vector<Strands> grown(count);
    job.workers.for_each(count, 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) grown[i] = tree.grow(first + i);
    });
    for (size_t i = 0; i < count; ++i) {
      if (grown[i].strand_count() > 0) use(first + i, grown[i]);
      stage.advance(1);
    }
    first += count;
  }
}

void write_bound(RibWriter& rib, const Box3f& box) {
  rib.numbers({box.min.x, box.max.x, box.min.y, box.max.y, box.min.z, box.max.z});
}

void write_procedural(RibWriter& rib, const CoatTree& tree, const HairArguments& arguments, const Job& job) {
  const Box3f box = tree.box(tree.all(), job);
  if (box.isEmpty()) return;
  rib.request("Procedural").text("DynamicLoad").texts({kPlugin, print_hair_arguments(arguments)});
  write_bound(rib, box);
}

void write_archives(RibWriter& rib, const CoatTree& tree, std::span<const float> times,
                    const std::filesystem::path& base, const std::filesystem::path& folder_of,
                    const RibFormat& format, const Job& job) {
  make_own_folder(base.parent_path());
  std::vector<Box3f> boxes;
  for (size_t leaf = 0; leaf < tree.all().end; ++leaf) boxes.push_back(tree.box({leaf, leaf + 1}, job));
  for_each_leaf(tree, job, [&](size_t leaf, const Strands& strands) {
    const std::filesystem::path path =
        base.string() + fmt::format(".{}.rib{}", leaf, format.gzip ? ".gz" : "");
    RibFile file(path, format, Links::kReplace);
    write_curves(file.writer(), strands, times);
    file.commit();
    rib.request("Procedural").text("DelayedReadArchive");
    rib.texts({path.lexically_relative(folder_of).string()});
    write_bound(rib, boxes[leaf]);
  });
}

void write_expanded(RibWriter& rib, const CoatTree& tree, std::span<const float> times, const Job& job) {
  for_each_leaf(tree, job, [&](size_t, const Strands& strands) { write_curves(rib, strands, times); });
}

}  // namespace pelage
