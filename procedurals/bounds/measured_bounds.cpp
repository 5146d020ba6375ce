// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/measured_bounds.h"

#include <algorithm>

#include "base/ledger.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "procedurals/bounds/bounds_file.h"
#include "procedurals/bounds/segment_parts.h"

namespace pelage {

size_t measuring_bytes(const StrandCounts& counts) {
  return (counts.points * counts.motion_keys * 4 + counts.attribute_floats) * sizeof(float) +
         SegmentParts::bytes_bound(counts.segments, counts.motion_keys);
}

bool MeasuredBounds::BoundsGroup::is_complete() const {
  return std::find(chunks.begin(), chunks.end(), kNone) == chunks.end();
}

MeasuredBounds::MeasuredBounds(const BoundingOptions& options, std::span<const Procedural* const> chunks,
                               const WarningSink& warn)
    : options_(options),
      span_(bound_span(options.strategy)),
      keys_(bound_keys(options.strategy)),
      chunks_(chunks),
      warn_([this, warn](const std::string& line) {
        const std::lock_guard lock(warning_);
        warn(line);
      }),
      bounds_(chunks.size()),
      areas_(chunks.size()),
      group_of_(chunks.size(), kNone),
      known_(chunks.size()) {
  for (ChunkBounds& chunk : bounds_) chunk.keys = keys_;
  find_groups();
}

void MeasuredBounds::find_groups() {
  for (uint32_t i = 0; i < chunks_.size(); ++i) {
    const std::optional<BoundsRecord> record = chunks_[i]->bounds_record();
    if (!record) continue;
    // Leaves of a coat are consecutive.
    if (groups_.empty() || groups_.back().record.key != record->key ||
        groups_.back().chunks[record->index] != kNone) {
      groups_.push_back({*record, std::vector<uint32_t>(record->count, kNone)});
    }
    groups_.back().chunks[record->index] = i;
  }
  left_ = std::vector<std::atomic<uint32_t>>(groups_.size());
  for (uint32_t f = 0; f < groups_.size(); ++f) {
    if (!groups_[f].is_complete()) continue;
    left_[f].store(static_cast<uint32_t>(groups_[f].chunks.size()), std::memory_order_relaxed);
    for (const uint32_t chunk : groups_[f].chunks) group_of_[chunk] = f;
  }
}

void MeasuredBounds::keep(uint32_t chunk, ChunkBounds bounds) {
  areas_[chunk] = area_of(bounds);
  bounds_[chunk] = std::move(bounds);
}

void MeasuredBounds::drop_parts(uint32_t chunk) {
  if (options_.in_one_part) bounds_[chunk] = std::move(bounds_[chunk]).in_one_part();
}

bool MeasuredBounds::is_known(const BoundsGroup& group) const {
  return std::any_of(group.chunks.begin(), group.chunks.end(),
                     [&](uint32_t chunk) { return chunk != kNone && known_[chunk]; });
}

void MeasuredBounds::read(const Job& job) { read(job, warn_); }

void MeasuredBounds::read(const Job& job, const WarningSink& warn) {
  job.workers.for_each(groups_.size(), 1, [&](WorkRange range) {
    for (size_t f = range.begin; f < range.end && !job.progress.cancelled(); ++f) {
      const BoundsGroup& group = groups_[f];
      if (is_known(group)) continue;
      std::vector<ChunkBounds> read = read_bounds(group.record, span_, keys_, warn);
      for (size_t i = 0; i < read.size(); ++i) {
        const uint32_t chunk = group.chunks[i];
        if (chunk == kNone) continue;
        keep(chunk, std::move(read[i]));
        drop_parts(chunk);
        known_[chunk] = true;
        job.progress.advance(1);
      }
    }
  });
}

std::optional<ContentStore::Lock> MeasuredBounds::lock(const Job& job) {
  const ContentStore* store = nullptr;
  ContentHasher missing;
  missing.add(span_).add(keys_);
  for (const BoundsGroup& group : groups_) {
    if (!group.is_complete() || is_known(group)) continue;
    store = group.record.store.get();
    missing.add(group.record.key).add(static_cast<uint64_t>(group.record.count));
  }
  if (!store) return {};
  ContentStore::Lock lock = store->lock("boxes", missing.digest(), [&] { return job.progress.cancelled(); });
  read(job, [](const std::string&) {});  // read() has warned of damaged files
  return lock;
}

void MeasuredBounds::measure(const Job& job) {
  std::vector<uint32_t> unknown;
  for (uint32_t i = 0; i < chunks_.size(); ++i) {
    if (!known_[i]) unknown.push_back(i);
  }
  job.workers.for_each(unknown.size(), 1, [&](WorkRange range) {
    for (size_t u = range.begin; u < range.end && !job.progress.cancelled(); ++u) {
      const Procedural& chunk = *chunks_[unknown[u]];
      {
        const MemoryCharge passing(job.ledger, MemoryTag::kChunks,
                                   static_cast<int64_t>(measuring_bytes(chunk.counts())));
        keep(unknown[u], chunk.exact_bounds(span_, keys_));
      }
      mark_known(unknown[u]);
      job.progress.advance(1);
    }
  });
}

/// Records a measured chunk. The last one of its group sees the results of all others.
void MeasuredBounds::mark_known(uint32_t chunk) {
  const uint32_t f = group_of_[chunk];
  if (f == kNone) return drop_parts(chunk);
  if (left_[f].fetch_sub(1, std::memory_order_acq_rel) > 1) return;
  write(groups_[f]);
  for (const uint32_t member : groups_[f].chunks) drop_parts(member);
}

void MeasuredBounds::write(const BoundsGroup& group) {
  std::vector<const ChunkBounds*> all;
  for (const uint32_t chunk : group.chunks) all.push_back(&bounds_[chunk]);
  write_bounds(group.record, span_, keys_, all, [this](const std::string& line) {
    {
      const std::lock_guard lock(warning_);
      if (warned_) return;
      warned_ = true;
    }
    warn_(line + "; later boxes that cannot be stored cause no further warning");
  });
}

BoundingCounts MeasuredBounds::counts() const {
  BoundingCounts counts;
  counts.remembered = std::count(known_.begin(), known_.end(), char(true));
  counts.measured = static_cast<int64_t>(chunks_.size()) - counts.remembered;
  for (const BoundsArea& area : areas_) counts.area += area;
  return counts;
}

}  // namespace pelage
