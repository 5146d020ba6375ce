// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur_chunk_file.h"

#include <cmath>
#include <cstring>
#include <string>
#include <system_error>

#include "base/error.h"
#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_tree_check.h"

namespace pelage {
namespace {

const std::string kChunksKind = "fur-chunks";
constexpr size_t kOverhead = size_t(16) << 10;  // small allocations of a chunk, generously
constexpr size_t kUnmet = 4096;                 // segments of a chunk in excess of full blocks
constexpr size_t kMaxHead = size_t(1) << 20;

enum ChunkSection : size_t { kHead, kPacked, kNodes, kLeaves };

/// Metadata of a chunk, followed by the metadata of its packed strands.
struct Head {
  uint32_t version, part;
  int32_t motion_keys;
  float step, anchor[3], reach;
  float low[3], high[3];
  uint32_t turned;
  float axes[9];
};

ContentHash entry_key(const ContentHash& key) {
  return ContentHasher().add("fur chunks").add(FurChunkFile::kVersion).add(key).digest();
}

/// For a tree that is not empty.
bool is_possible(const FurBox& box) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.low[axis]) || !std::isfinite(box.high[axis]) || box.low[axis] > box.high[axis])
      return false;
  }
  return true;
}

/// Segments that cannot be hit are in no leaf. A chunk that has hardly any others is not stored, so that a
/// small file cannot make its reader allocate disproportionate memory.
bool is_in_proportion(size_t segments, size_t leaf_bytes, int motion_keys) {
  return segments <= FurBlockHeader::kLanes * (leaf_bytes / kNarrowBlock.block(motion_keys)) + kUnmet;
}

[[noreturn]] void refuse(const StoredSections& file) {
  throw Error(ErrorKind::kInput, {file.path().string(), 0, 0}, "damaged fur chunks");
}

}  // namespace

FurChunkFile::Writer::Writer(const ContentStore& store, const ContentHash& key)
    : entry_(store.writer(kChunksKind, entry_key(key))) {}

void FurChunkFile::Writer::add(const FurChunk* chunk) {
  if (!chunk || !is_in_proportion(chunk->segment_count(), chunk->tree().leaf_bytes(),
                                  chunk->tree().view().motion_keys)) {
    for (size_t i = 0; i < kSections; ++i) entry_.add(std::span<const std::byte>());
    return;
  }
  const FurTree& tree = chunk->tree();
  const FurTreeView& view = tree.view();
  Head head{};
  head.version = kVersion;
  head.part = chunk->part();
  head.motion_keys = view.motion_keys;
  head.step = view.step;
  head.reach = view.reach;
  for (size_t axis = 0; axis < 3; ++axis) {
    head.anchor[axis] = view.anchor[static_cast<int>(axis)];
    head.low[axis] = tree.box().low[axis];
    head.high[axis] = tree.box().high[axis];
    for (size_t i = 0; i < 3; ++i) head.axes[3 * axis + i] = view.frame.axes[axis][static_cast<int>(i)];
  }
  head.turned = view.frame.turned ? 1 : 0;
  std::vector<std::byte> known(sizeof(Head));
  std::memcpy(known.data(), &head, sizeof(Head));
  const std::vector<std::byte> packed = chunk->strands().stored_head();
  known.insert(known.end(), packed.begin(), packed.end());
  entry_.add(std::span<const std::byte>(known));
  entry_.add(chunk->strands().stored_block());
  entry_.add(std::span<const std::byte>(view.nodes, tree.node_bytes()));
  entry_.add(std::span<const std::byte>(view.leaves, tree.leaf_bytes()));
}

bool FurChunkFile::Writer::commit(const WarningSink& warn) { return entry_.commit(warn); }

std::unique_ptr<const FurChunkFile> FurChunkFile::open(const ContentStore& store, const ContentHash& key,
                                                       size_t chunk_count, const WarningSink& warn) {
  std::optional<StoredSections> file = store.open_sections(kChunksKind, entry_key(key), warn);
  if (!file) return nullptr;
  if (file->section_count() != kSections * chunk_count) {
    warn(file->path().string() + ": damaged fur chunks; they are made again");
    return nullptr;
  }
  return std::make_unique<const FurChunkFile>(std::move(*file));
}

FurChunkFile::FurChunkFile(StoredSections file)
    : file_(std::move(file)), lost_(std::make_unique<std::atomic<bool>[]>(chunk_count())) {}

size_t FurChunkFile::bytes_bound(uint32_t chunk) const {
  const size_t first = kSections * size_t(chunk);
  const uint64_t nodes = file_.section_bytes(first + kNodes), leaves = file_.section_bytes(first + kLeaves);
  const size_t places =
      FurSegmentLookup::bytes_bound(leaves / kNarrowBlock.block(1) * FurBlockHeader::kLanes + kUnmet);
  return kOverhead + 2 * file_.section_bytes(first + kHead) +
         PageBlock::held_bytes(file_.section_bytes(first + kPacked)) +
         PageBlock::held_bytes(FurTree::leaves_offset(nodes) + leaves) + places;
}

std::unique_ptr<FurChunk> FurChunkFile::read(uint32_t chunk, const WarningSink& warn, PagePool* pool) const {
  std::unique_ptr<FurChunk> result;
  try {
    result = parse(chunk, pool);
  } catch (const Error& error) {
    lost_[chunk].store(true, std::memory_order_relaxed);
    if (is_damaged_.exchange(true)) return nullptr;
    std::error_code why;
    std::filesystem::remove(file_.path(), why);
    warn(std::string(error.what()) + "; the chunk is grown instead" +
         (why ? "; the file cannot be deleted: " + why.message() : ", and the next run makes it again"));
    return nullptr;
  }
  chunks_read_.fetch_add(1, std::memory_order_relaxed);
  uint64_t bytes = 0;
  for (size_t i = 0; i < kSections; ++i) bytes += file_.section_bytes(kSections * size_t(chunk) + i);
  bytes_read_.fetch_add(static_cast<int64_t>(bytes), std::memory_order_relaxed);
  return result;
}

std::unique_ptr<FurChunk> FurChunkFile::parse(uint32_t chunk, PagePool* pool) const {
  const size_t first = kSections * size_t(chunk);
  const uint64_t known_bytes = file_.section_bytes(first + kHead);
  if (known_bytes < sizeof(Head) || known_bytes > kMaxHead) refuse(file_);
  std::vector<std::byte> known(known_bytes);
  file_.read(first + kHead, known);
  Head head;
  std::memcpy(&head, known.data(), sizeof(head));
  if (head.version != kVersion) refuse(file_);
  FurTreeView view;
  view.motion_keys = head.motion_keys;
  view.step = head.step;
  view.anchor = V3f(head.anchor[0], head.anchor[1], head.anchor[2]);
  view.reach = head.reach;
  view.frame.turned = head.turned != 0;
  for (size_t i = 0; i < 3; ++i)
    view.frame.axes[i] = V3f(head.axes[3 * i], head.axes[3 * i + 1], head.axes[3 * i + 2]);
  if (!has_possible_grid(view)) refuse(file_);

  PageBlock block(file_.section_bytes(first + kPacked));
  file_.read(first + kPacked, {block.data(), file_.section_bytes(first + kPacked)});
  std::optional<PackedStrands> strands =
      PackedStrands::from_stored(std::span(known).subspan(sizeof(Head)), std::move(block));
  if (!strands || strands->motion_keys() != head.motion_keys) refuse(file_);

  const size_t nodes = file_.section_bytes(first + kNodes), leaves = file_.section_bytes(first + kLeaves);
  if (!is_in_proportion(strands->segment_count(), leaves, head.motion_keys)) refuse(file_);
  const size_t begin = FurTree::leaves_offset(nodes);
  PageBlock tree = FurTree::make_block(pool, begin + leaves);
  file_.read(first + kNodes, {tree.data(), nodes});
  file_.read(first + kLeaves, {tree.data() + begin, leaves});
  view.nodes = tree.data();
  view.leaves = tree.data() + begin;
  if (nodes > 0 && (!has_possible_nodes(view, nodes, leaves) ||
                    !has_possible_segments(view, nodes, strands->segment_count()))) {
    refuse(file_);
  }
  FurBox box;
  for (size_t axis = 0; axis < 3; ++axis) box.low[axis] = head.low[axis], box.high[axis] = head.high[axis];
  if (nodes > 0 && !is_possible(box)) refuse(file_);
  return std::make_unique<FurChunk>(head.part, chunk, std::move(*strands),
                                    FurTree(view, box, std::move(tree), nodes, leaves));
}

}  // namespace pelage
