// SPDX-License-Identifier: Apache-2.0
#include "render/frame/stored_fur.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace pelage {
namespace {

/// Hash of everything that affects the chunks' bytes; empty when one of them has no hash.
std::optional<ContentHash> content_of(const FrameChunks& chunks, const FurChunkOptions& options) {
  ContentHasher hasher;
  hasher.add("stored fur").add(options.compact_attributes);
  hasher.add(options.tree.build.node_cost).add(options.tree.build.rotation);
  for (uint32_t leaf = 0; leaf < chunks.leaves().size(); ++leaf) {
    const std::optional<ContentHash> content = chunks.leaves()[leaf]->content();
    if (!content) return {};
    const StrandScale scale = chunks.scale(leaf);
    hasher.add(*content).add(chunks.part(leaf));
    hasher.add(scale.width).add(scale.anchor.x).add(scale.anchor.y).add(scale.anchor.z);
    hasher.add(static_cast<int>(chunks.counts(leaf).motion_keys));
  }
  return hasher.add(static_cast<uint64_t>(chunks.leaves().size())).digest();
}

/// Grows all fur once, a few chunks at a time, and writes it in order; stops at the first failed write.
bool write(const ContentStore& store, const ContentHash& key, const FrameChunks& chunks,
           const ResidentChunksOptions& options, const Job& job) {
  FurChunkFile::Writer writer(store, key);
  const size_t leaves = chunks.leaves().size();
  job.progress.begin("store fur", static_cast<double>(leaves));
  for (uint32_t next = 0; next < leaves && !job.progress.cancelled() && !writer.failed();) {
    // As many as threads and memory allow, but at least one.
    std::vector<MemoryCharge> charges;
    while (next + charges.size() < leaves &&
           charges.size() < static_cast<size_t>(job.workers.thread_count())) {
      const auto chunk = static_cast<uint32_t>(next + charges.size());
      const auto bytes = static_cast<int64_t>(FurChunk::bytes_bound(chunks.counts(chunk), options.fur));
      const bool fits = options.memory_limit == 0 ||
                        job.ledger.budgeted() + bytes <= static_cast<int64_t>(options.memory_limit);
      if (!fits && !charges.empty()) break;
      charges.emplace_back(job.ledger, MemoryTag::kChunks, bytes);
    }
    std::vector<std::unique_ptr<FurChunk>> made(charges.size());
    job.workers.for_each(made.size(), 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        const auto chunk = static_cast<uint32_t>(next + i);
        made[i] =
            std::make_unique<FurChunk>(chunks.grow(chunk), chunk, FurGrid(chunks.scale(chunk)), options.fur);
      }
    });
    for (const auto& chunk : made) writer.add(chunk.get());
    next += static_cast<uint32_t>(made.size());
    job.progress.advance(static_cast<double>(made.size()));
  }
  job.progress.end();
  if (job.progress.cancelled()) return false;
  return writer.commit([&](const std::string& line) { job.progress.warn(line); });
}

}  // namespace

std::shared_ptr<const FurChunkFile> stored_fur(const RenderParams& params, const FrameChunks& chunks,
                                               const ResidentChunksOptions& options, const Job& job) {
  const WarningSink warn = [&](const std::string& line) { job.progress.warn(line); };
  const std::optional<ContentHash> key = content_of(chunks, options.fur);
  if (!key || !chunks.opaque()) {
    warn(std::string("render.bvh.file: ") +
         (key ? "fur that is not opaque cannot be stored" : "the frame has no fur to store") +
         "; rendering without a store");
    return nullptr;
  }
  const ContentStore store(params.bvh.file.path);
  const auto open = [&](const WarningSink& tell) {
    return FurChunkFile::open(store, *key, chunks.leaves().size(), tell);
  };
  if (auto file = open(warn)) return file;
  store.sweep();
  const ContentStore::Lock lock = store.lock("fur-chunks", *key, [&] { return job.progress.cancelled(); });
  if (lock.held()) {
    // The previous holder of the lock may have written them.
    if (auto file = open([](const std::string&) {})) return file;
  }
  if (!write(store, *key, chunks, options, job)) return nullptr;
  store.prune(ContentStore::kUnusedAge);
  return open(warn);
}

}  // namespace pelage
