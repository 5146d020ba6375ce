// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur/fur_pages.h"

namespace pelage {

class Workers;

/// Fur trees on disk: an entry of kind "fur" in a content store. Its sections are the pages, each with its
/// own checksum, followed by the table: counts, trees, treelets, boxes. Pages are read one by one, never
/// mapped; every page is verified and validated before it is traced.
///
/// Thread safety: const members may be called from any thread.
class FurPageFile {
 public:
  /// Incremented whenever the same strands would give different pages.
  static constexpr uint32_t kVersion = 3;

  /// Writes an entry, tree by tree; it exists after commit(), which reports file system errors to `warn`.
  class Writer {
   public:
    Writer(const ContentStore& store, const ContentHash& key, size_t page_bytes = FurCutter::kPageBytes);
    void add(const FurTree& tree) { cutter_.add(tree); }
    bool commit(const WarningSink& warn);

   private:
    ContentStore::Writer entry_;
    FurCutter cutter_;
  };

  /// Returns nothing if the entry is missing, or if its table shows that it is damaged or foreign. Calls
  /// `warn` for a damaged or foreign entry.
  static std::optional<FurPageFile> open(const ContentStore& store, const ContentHash& key,
                                         const WarningSink& warn);
  /// Opens a file, whatever its name. Throws Error (kInput).
  explicit FurPageFile(StoredSections file);

  const FurPageTable& table() const { return table_; }
  /// Memory of this object.
  size_t bytes() const {
    return file_.bytes() + table_.bytes() + first_treelet_.capacity() * sizeof(uint32_t);
  }

  /// The treelets of a page: from first_treelet(page) to first_treelet(page + 1).
  uint32_t first_treelet(uint32_t page) const { return first_treelet_[page]; }
  /// Reads one page into `out`, which must be as long as the page and aligned to 64 bytes. Throws Error
  /// (kInput) when the page cannot be read or its checksum is wrong.
  void read(uint32_t page, std::span<std::byte> out) const;
  /// Announces that a page will be read next, so that the system may load it.
  void prefetch(uint32_t page) const { file_.prefetch(page); }
  /// Reads and verifies all pages. Returns whether they are intact; calls `warn` otherwise.
  bool check_all(const Workers& workers, const WarningSink& warn) const;

 private:
  template <class T>
  std::vector<T> values(size_t section) const;

  StoredSections file_;
  FurPageTable table_;
  std::vector<uint32_t> first_treelet_;
};

}  // namespace pelage
