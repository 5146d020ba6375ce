// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur/fur_pages.h"

namespace pelage {

class Workers;

/// Fur trees on disk: an entry of kind "fur" of a content store. Its sections are the pages, each with a
/// checksum of its own, and then the table: counts, trees, treelets, boxes. Pages are read one by one, never
/// mapped; every page that is read is checked, and found possible, before a ray sees it.
///
/// Thread safety: const members may be called from any thread.
class FurPageFile {
 public:
  /// Counts up whenever the same strands would give other pages.
  static constexpr uint32_t kVersion = 3;

  /// Writes an entry, tree by tree; it exists from commit() on. What the file system refuses is told to
  /// commit()'s `warn`.
  class Writer {
   public:
    Writer(const ContentStore& store, const ContentHash& key, size_t page_bytes = FurCutter::kPageBytes);
    void add(const FurTree& tree) { cutter_.add(tree); }
    bool commit(const WarningSink& warn);

   private:
    ContentStore::Writer entry_;
    FurCutter cutter_;
  };

  /// Nothing when there is no such entry, or one that is damaged or foreign as far as its table tells: then
  /// `warn` has been told.
  static std::optional<FurPageFile> open(const ContentStore& store, const ContentHash& key,
                                         const WarningSink& warn);
  /// A file by itself, whatever its name. Throws Error (kInput).
  explicit FurPageFile(StoredSections file);

  const FurPageTable& table() const { return table_; }
  /// What this object holds.
  size_t bytes() const {
    return file_.bytes() + table_.bytes() + first_treelet_.capacity() * sizeof(uint32_t);
  }

  /// The treelets of a page: from first_treelet(page) to first_treelet(page + 1).
  uint32_t first_treelet(uint32_t page) const { return first_treelet_[page]; }
  /// Reads one page; `out` is as long as it and aligned to 64 bytes. Throws Error (kInput) when it cannot be
  /// read or is not what was written.
  void read(uint32_t page, std::span<std::byte> out) const;
  /// Says that a page will be read next: the system may fetch it meanwhile.
  void prefetch(uint32_t page) const { file_.prefetch(page); }
  /// Reads all pages once. Whether they are what was written; otherwise `warn` has been told.
  bool check_all(const Workers& workers, const WarningSink& warn) const;

 private:
  template <class T>
  std::vector<T> values(size_t section) const;

  StoredSections file_;
  FurPageTable table_;
  std::vector<uint32_t> first_treelet_;
};

}  // namespace pelage
