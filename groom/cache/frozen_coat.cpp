// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/frozen_coat.h"

#include <cmath>
#include <cstring>

#include "base/check.h"

namespace pelage {
namespace {

constexpr const char* kOffsetsKind = "offsets";

/// Section 0; the leaves follow. Increment the version when the meaning of a leaf's bytes changes.
struct Head {
  uint32_t version = 2;
  uint32_t leaves = 0;
  uint64_t strands = 0;
};

/// Files of other versions have other names, so they are not taken for damaged.
ContentHash offsets_key(const ContentHash& key) {
  return ContentHasher().add(key).add(Head().version).add(growth_version::kFrozen).digest();
}

bool fits(const FrozenLeaf& frozen, const CoatSource& source, const FollicleTree::Leaf& leaf) {
  if (frozen.strand_count() != leaf.end - leaf.begin) return false;
  for (const FrozenLeaf::Block& block : frozen.blocks()) {
    const size_t begin = leaf.begin + block.first;
    if (block.count != source.run_length(begin, leaf.end) || block.points != source.strand_points(begin))
      return false;
  }
  return true;
}

}  // namespace

std::filesystem::path FrozenCoat::file(const ContentStore& store, const ContentHash& key) {
  return store.file(kOffsetsKind, offsets_key(key));
}

std::optional<FrozenCoat> FrozenCoat::open(const ContentStore& store, const ContentHash& key,
                                           const CoatSource& source, const WarningSink& warn) {
  std::optional<StoredFile> file = store.open(kOffsetsKind, offsets_key(key), warn);
  if (!file) return {};
  const auto refuse = [&]() -> std::optional<FrozenCoat> {
    warn(FrozenCoat::file(store, key).string() +
         ": damaged cache file: its strands do not match the groom; it is made again");
    return {};
  };
  const auto leaves = source.follicles().leaves();
  FrozenCoat coat;
  coat.file_ = std::move(file);
  if (coat.file_->section_count() != leaves.size() + 1) return refuse();
  const std::span<const std::byte> first = coat.file_->section(0);
  Head head;
  if (first.size() != sizeof(head) + leaves.size() * sizeof(StrandReach)) return refuse();
  std::memcpy(&head, first.data(), sizeof(head));
  if (head.version != Head().version || head.leaves != leaves.size()) return refuse();
  coat.reaches_.resize(leaves.size());
  if (!leaves.empty())
    std::memcpy(coat.reaches_.data(), first.data() + sizeof(head), first.size() - sizeof(head));
  for (size_t i = 0; i < leaves.size(); ++i) {
    std::optional<FrozenLeaf> leaf = FrozenLeaf::read(coat.file_->section(i + 1));
    if (!leaf || !fits(*leaf, source, leaves[i])) return refuse();
    coat.leaves_.push_back(std::move(*leaf));
  }
  return coat;
}

FrozenCoat::FrozenCoat(std::vector<std::vector<std::byte>> leaves, std::vector<StrandReach> reaches,
                       MemoryLedger& ledger)
    : memory_(std::move(leaves)), reaches_(std::move(reaches)) {
  for (const std::vector<std::byte>& bytes : memory_) {
    std::optional<FrozenLeaf> leaf = FrozenLeaf::read(bytes);
    PELAGE_CHECK(leaf.has_value());
    leaves_.push_back(std::move(*leaf));
  }
  charge_ = MemoryCharge(ledger, MemoryTag::kOperatorCache, static_cast<int64_t>(bytes()));
}

bool FrozenCoat::store(const ContentStore& store, const ContentHash& key,
                       const std::vector<std::vector<std::byte>>& leaves,
                       const std::vector<StrandReach>& reaches, const WarningSink& warn) {
  Head head;
  head.leaves = static_cast<uint32_t>(leaves.size());
  std::vector<std::byte> first(sizeof(head) + reaches.size() * sizeof(StrandReach));
  std::memcpy(first.data(), &head, sizeof(head));
  if (!reaches.empty())
    std::memcpy(first.data() + sizeof(head), reaches.data(), reaches.size() * sizeof(StrandReach));
  ContentStore::Writer writer = store.writer(kOffsetsKind, offsets_key(key));
  writer.add(first);
  for (const std::vector<std::byte>& leaf : leaves) writer.add(leaf);
  return writer.commit(warn);
}

size_t FrozenCoat::bytes() const {
  size_t total = 0;
  for (const FrozenLeaf& leaf : leaves_) total += leaf.bytes();
  return total;
}

}  // namespace pelage
