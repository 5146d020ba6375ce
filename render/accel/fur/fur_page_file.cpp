// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_page_file.h"

#include <mutex>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/page_block.h"
#include "base/parallel.h"

namespace pelage {
namespace {

const std::string kFurKind = "fur";
constexpr size_t kTables = 4;  // sections after the pages

struct Head {
  uint32_t version = FurPageFile::kVersion;
  int32_t box_keys = 1;
  uint32_t reserved[2] = {};
};

/// A tree without padding, so that equal trees are equal bytes.
struct StoredTree {
  uint32_t layout;
  int32_t motion_keys;
  float step, anchor[3], reach;
  uint32_t turned;
  float axes[3][3];
};

static_assert(sizeof(FurTreelet) == 20 && std::is_trivially_copyable_v<FurTreelet>);

ContentHash entry_key(const ContentHash& key) {
  return ContentHasher().add("fur").add(FurPageFile::kVersion).add(key).digest();
}

[[noreturn]] void refuse(const StoredSections& file) {
  throw Error(ErrorKind::kInput, {file.path().string(), 0, 0}, "damaged fur pages");
}

}  // namespace

FurPageFile::Writer::Writer(const ContentStore& store, const ContentHash& key, size_t page_bytes)
    : entry_(store.writer(kFurKind, entry_key(key))),
      cutter_([this](std::span<const std::byte> page) { entry_.add(page); }, page_bytes) {}

bool FurPageFile::Writer::commit(const WarningSink& warn) {
  const FurPageTable table = cutter_.finish();
  Head head;
  head.box_keys = table.box_keys;
  std::vector<StoredTree> trees;
  for (const FurPagedTree& t : table.trees) {
    StoredTree& stored = trees.emplace_back();
    stored.layout = static_cast<uint32_t>(t.layout);
    stored.motion_keys = t.motion_keys;
    stored.step = t.step;
    stored.reach = t.reach;
    stored.turned = t.frame.turned ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      stored.anchor[axis] = t.anchor[axis];
      for (size_t i = 0; i < 3; ++i) stored.axes[i][axis] = t.frame.axes[i][axis];
    }
  }
  std::vector<float> boxes;
  for (const Box3f& b : table.boxes) {
    boxes.insert(boxes.end(), {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z});
  }
  entry_.add(std::span<const Head>(&head, 1));
  entry_.add(std::span<const StoredTree>(trees));
  entry_.add(std::span<const FurTreelet>(table.treelets));
  entry_.add(std::span<const float>(boxes));
  return entry_.commit(warn);
}

std::optional<FurPageFile> FurPageFile::open(const ContentStore& store, const ContentHash& key,
                                             const WarningSink& warn) {
  std::optional<StoredSections> file = store.open_sections(kFurKind, entry_key(key), warn);
  if (!file) return {};
  try {
    return FurPageFile(std::move(*file));
  } catch (const Error& e) {
    warn(std::string(e.what()) + "; it is made again");
    return {};
  }
}

template <class T>
std::vector<T> FurPageFile::values(size_t section) const {
  const uint64_t bytes = file_.section_bytes(section);
  if (bytes % sizeof(T) != 0) refuse(file_);
  std::vector<T> result(bytes / sizeof(T));
  if (bytes > 0) file_.read(section, std::as_writable_bytes(std::span(result)));
  return result;
}

FurPageFile::FurPageFile(StoredSections file) : file_(std::move(file)) {
  if (file_.kind() != kFurKind || file_.section_count() < kTables) refuse(file_);
  const size_t pages = file_.section_count() - kTables;
  const auto head = values<Head>(pages);
  if (head.size() != 1 || head[0].version != kVersion) refuse(file_);
  table_.box_keys = head[0].box_keys;
  for (const StoredTree& t : values<StoredTree>(pages + 1)) {
    if (t.layout > static_cast<uint32_t>(FurNodeLayout::kQuantised) || t.turned > 1) refuse(file_);
    FurPagedTree& tree = table_.trees.emplace_back();
    tree.layout = static_cast<FurNodeLayout>(t.layout);
    tree.motion_keys = t.motion_keys;
    tree.step = t.step;
    tree.reach = t.reach;
    tree.frame.turned = t.turned == 1;
    for (int axis = 0; axis < 3; ++axis) {
      tree.anchor[axis] = t.anchor[axis];
      for (size_t i = 0; i < 3; ++i) tree.frame.axes[i][axis] = t.axes[i][axis];
    }
  }
  table_.treelets = values<FurTreelet>(pages + 2);
  const auto boxes = values<float>(pages + 3);
  if (boxes.size() % 6 != 0) refuse(file_);
  table_.boxes.reserve(boxes.size() / 6);
  for (size_t i = 0; i < boxes.size(); i += 6) {
    const float* b = &boxes[i];
    table_.boxes.emplace_back(V3f(b[0], b[1], b[2]), V3f(b[3], b[4], b[5]));
  }
  table_.page_bytes.reserve(pages);
  for (size_t page = 0; page < pages; ++page) {
    if (file_.section_bytes(page) == 0 || file_.section_bytes(page) > UINT32_MAX) refuse(file_);
    table_.page_bytes.push_back(static_cast<uint32_t>(file_.section_bytes(page)));
  }
  if (!table_.is_possible()) refuse(file_);
  first_treelet_.assign(pages + 1, 0);
  for (const FurTreelet& t : table_.treelets) ++first_treelet_[t.page + 1];
  for (size_t page = 0; page < pages; ++page) first_treelet_[page + 1] += first_treelet_[page];
}

void FurPageFile::read(uint32_t page, std::span<std::byte> out) const {
  file_.read(page, out);
  for (uint32_t t = first_treelet(page); t < first_treelet(page + 1); ++t) {
    const FurTreelet& treelet = table_.treelets[t];
    const FurTreeView view = treelet_view(table_.trees[treelet.tree], treelet, out.data());
    if (!is_possible_treelet(view, treelet)) refuse(file_);
  }
}

bool FurPageFile::check_all(const Workers& workers, const WarningSink& warn) const {
  std::mutex mutex;
  std::string wrong;
  workers.for_each(table_.page_bytes.size(), 16, [&](WorkRange range) {
    PageBlock frame(table_.largest_page());
    for (size_t page = range.begin; page < range.end; ++page) {
      try {
        read(static_cast<uint32_t>(page), {frame.data(), table_.page_bytes[page]});
      } catch (const Error& e) {
        const std::lock_guard lock(mutex);
        if (wrong.empty()) wrong = e.what();
        return;
      }
    }
  });
  if (!wrong.empty()) warn(wrong + "; it is made again");
  return wrong.empty();
}

}  // namespace pelage
