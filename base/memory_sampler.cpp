// SPDX-License-Identifier: Apache-2.0
#include "base/memory_sampler.h"

namespace pelage {

MemorySampler::MemorySampler(const MemoryLedger& ledger, Clock::time_point start, double interval_s)
    : ledger_(ledger),
      start_(start),
      interval_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval_s))),
      thread_([this] { run(); }) {}

MemorySampler::~MemorySampler() { stop(); }

const MemoryHistory& MemorySampler::stop() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  return history_;
}

void MemorySampler::run() {
  std::unique_lock lock(mutex_);
  do {
    lock.unlock();
    take();
    lock.lock();
  } while (!wake_.wait_for(lock, interval_, [&] { return stopping_; }));
  lock.unlock();
  take();
}

void MemorySampler::take() {
  MemorySample sample;
  // Reads the tags before the resident size. Otherwise memory that is charged but not yet touched could count
  // as explained before it is resident.
  for (size_t tag = 0; tag < sample.tags.size(); ++tag)
    sample.tags[tag] = ledger_.current(static_cast<MemoryTag>(tag));
  sample.resident = resident_memory();
  sample.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  if (sample.resident.anonymous >= history_.highest.resident.anonymous) history_.highest = sample;

  std::vector<MemorySample>& timeline = history_.timeline;
  if (timeline.size() == kMaxSamples) {
    for (size_t i = 0; 2 * i < timeline.size(); ++i) timeline[i] = timeline[2 * i];
    timeline.resize(kMaxSamples / 2);
    interval_ *= 2;
  }
  timeline.push_back(sample);
}

}  // namespace pelage
