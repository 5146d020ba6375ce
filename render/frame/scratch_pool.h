// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <semaphore>
#include <utility>
#include <vector>

#include "render/frame/sample_scratch.h"

namespace pelage {

/// The scratches of an integrator. A thread borrows one for each tile. If there are fewer scratches than
/// threads, because memory is short, threads wait for each other.
class ScratchPool {
 public:
  explicit ScratchPool(std::vector<std::unique_ptr<SampleScratch>> all)
      : all_(std::move(all)), free_(static_cast<std::ptrdiff_t>(all_.size())) {
    for (const auto& scratch : all_) idle_.push_back(scratch.get());
  }

  /// A scratch that no other thread uses. Waits until there is one.
  class Lease {
   public:
    Lease(ScratchPool& pool, int worker) : pool_(pool) {
      pool_.free_.acquire();
      const std::scoped_lock lock(pool_.mutex_);
      scratch_ = pool_.idle_.back();
      pool_.idle_.pop_back();
      scratch_->thread.worker = worker;
    }
    ~Lease() {
      {
        const std::scoped_lock lock(pool_.mutex_);
        pool_.idle_.push_back(scratch_);
      }
      pool_.free_.release();
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    SampleScratch& scratch() const { return *scratch_; }

   private:
    ScratchPool& pool_;
    SampleScratch* scratch_ = nullptr;
  };

  const std::vector<std::unique_ptr<SampleScratch>>& all() const { return all_; }

 private:
  std::vector<std::unique_ptr<SampleScratch>> all_;
  std::counting_semaphore<> free_;  // its count is the size of idle_
  std::mutex mutex_;                // guards idle_
  std::vector<SampleScratch*> idle_;
};

}  // namespace pelage
