// SPDX-License-Identifier: Apache-2.0
#include "base/page_pool.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <new>

#include <sys/mman.h>

#include "base/check.h"

namespace pelage {
namespace {

constexpr size_t kLargePage = size_t(2) << 20;
constexpr size_t kPiece = size_t(256) << 20;
constexpr size_t kMaxPieceBytes = size_t(16) << 20;  // larger blocks have large pages without a pool
constexpr size_t kMinPieceBytes = 64 * 1024;         // as in PageBlock: smaller ones come from the heap

}  // namespace

PagePool::~PagePool() {
  for (const Piece& piece : pieces_) {
    PELAGE_CHECK(piece.free.size() == 1 && piece.free.begin()->second == kPiece);
    ::munmap(piece.mapping, kPiece + kLargePage);
  }
}

PageBlock PagePool::take(size_t bytes) {
  const size_t held = PageBlock::held_bytes(bytes);
  if (held < kMinPieceBytes || held > kMaxPieceBytes) {
    PageBlock block(bytes);
    block.prefer_large_pages();
    return block;
  }
  const std::lock_guard lock(mutex_);
  for (Piece& piece : pieces_) {
    if (std::byte* data = take_from(piece, held)) return PageBlock(*this, data, held);
  }
  pieces_.push_back(make_piece());
  return PageBlock(*this, take_from(pieces_.back(), held), held);
}

PagePool::Piece PagePool::make_piece() {
  // Only pages that are written to use memory.
  void* mapping = ::mmap(nullptr, kPiece + kLargePage, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping == MAP_FAILED) throw std::bad_alloc();
  const auto address = reinterpret_cast<uintptr_t>(mapping);
  const uintptr_t aligned = (address + kLargePage - 1) / kLargePage * kLargePage;
  Piece piece;
  piece.mapping = mapping;
  piece.begin = static_cast<std::byte*>(mapping) + (aligned - address);
  piece.free[0] = kPiece;
#ifdef MADV_HUGEPAGE
  ::madvise(piece.begin, kPiece, MADV_HUGEPAGE);
#endif
  return piece;
}

/// Takes the lowest free range that is large enough, which keeps blocks together.
std::byte* PagePool::take_from(Piece& piece, size_t bytes) {
  const auto found = std::find_if(piece.free.begin(), piece.free.end(),
                                  [bytes](const auto& range) { return range.second >= bytes; });
  if (found == piece.free.end()) return nullptr;
  const auto [place, room] = *found;
  piece.free.erase(found);
  if (room > bytes) piece.free[place + bytes] = room - bytes;
  return piece.begin + place;
}

void PagePool::release_block(std::byte* data, size_t bytes) {
  ::madvise(data, bytes, MADV_DONTNEED);
  const std::lock_guard lock(mutex_);
  const auto piece = std::find_if(pieces_.begin(), pieces_.end(), [data](const Piece& p) {
    return data >= p.begin && data < p.begin + kPiece;
  });
  PELAGE_CHECK(piece != pieces_.end());
  auto place = static_cast<size_t>(data - piece->begin);
  auto next = piece->free.lower_bound(place);
  if (next != piece->free.end() && next->first == place + bytes) {
    bytes += next->second;
    next = piece->free.erase(next);
  }
  if (next != piece->free.begin()) {
    const auto before = std::prev(next);
    if (before->first + before->second == place) {
      before->second += bytes;
      return;
    }
  }
  piece->free[place] = bytes;
}

}  // namespace pelage
