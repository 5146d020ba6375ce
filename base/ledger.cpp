// SPDX-License-Identifier: Apache-2.0
#include "base/ledger.h"

#include <utility>

namespace pelage {

std::string_view memory_tag_name(MemoryTag tag) {
  switch (tag) {
    case MemoryTag::kChunks:
      return "chunks";
    case MemoryTag::kSkins:
      return "skins";
    case MemoryTag::kGrooms:
      return "grooms";
    case MemoryTag::kOperatorCache:
      return "operator_cache";
    case MemoryTag::kReflectionCache:
      return "reflection_cache";
    case MemoryTag::kFilm:
      return "film";
    case MemoryTag::kTextures:
      return "textures";
    case MemoryTag::kLibraries:
      return "libraries";
    case MemoryTag::kCount:
      break;
  }
  return "unknown";
}

void MemoryLedger::charge(MemoryTag tag, int64_t bytes) {
  Account& account = accounts_[static_cast<size_t>(tag)];
  const int64_t now = account.current.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  int64_t peak = account.peak.load(std::memory_order_relaxed);
  while (now > peak && !account.peak.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
  }
}

int64_t MemoryLedger::current(MemoryTag tag) const {
  return accounts_[static_cast<size_t>(tag)].current.load(std::memory_order_relaxed);
}

int64_t MemoryLedger::peak(MemoryTag tag) const {
  return accounts_[static_cast<size_t>(tag)].peak.load(std::memory_order_relaxed);
}

bool MemoryLedger::is_budgeted(MemoryTag tag) { return tag != MemoryTag::kLibraries; }

int64_t MemoryLedger::budgeted() const {
  int64_t bytes = 0;
  for (int tag = 0; tag < static_cast<int>(MemoryTag::kCount); ++tag) {
    if (is_budgeted(static_cast<MemoryTag>(tag))) bytes += current(static_cast<MemoryTag>(tag));
  }
  return bytes;
}

MemoryCharge::MemoryCharge(MemoryLedger& ledger, MemoryTag tag, int64_t bytes)
    : ledger_(&ledger), tag_(tag), bytes_(bytes) {
  ledger_->charge(tag_, bytes_);
}

MemoryCharge::MemoryCharge(MemoryCharge&& other) noexcept
    : ledger_(std::exchange(other.ledger_, nullptr)), tag_(other.tag_), bytes_(other.bytes_) {}

MemoryCharge& MemoryCharge::operator=(MemoryCharge&& other) noexcept {
  std::swap(ledger_, other.ledger_);
  std::swap(tag_, other.tag_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

MemoryCharge::~MemoryCharge() {
  if (ledger_) ledger_->charge(tag_, -bytes_);
}

}  // namespace pelage
