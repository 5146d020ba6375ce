// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/content_store.h"
#include "render/accel/fur/fur_pages.h"

namespace pelage {

class Workers;

/// Fur trees in a file: an entry of kind "fur" in a content store. The sections of the entry are the pages,
/// each with its own checksum, followed by the table: counts, trees, treelets, boxes. Pages are read one by
/// one; the file is not memory-mapped. read() verifies and validates each page, so only intact pages are
/// traced.
///
/// Thread safety: const members may be called from any thread.
class FurPageFile {
 public:
  /// Version of the stored data. Must be incremented by every change that gives different pages for the same
  /// strands.
  static constexpr uint32_t kVersion = 3;

  /// Writes an entry, tree by tree. The entry exists only after commit() has returned true. commit() reports
  /// file system errors to `warn`.
  class Writer {
   public:
    Writer(const ContentStore& store, const ContentHash& key, size_t page_bytes = FurCutter::kPageBytes);
    void add(const FurTree& tree) { cutter_.add(tree); }
    bool commit(const WarningSink& warn);

   private:
    ContentStore::Writer entry_;
    FurCutter cutter_;
  };

  /// Opens an entry. Returns nothing if the entry is missing. Also returns nothing, and calls `warn`, if the
  /// file's table shows that the file is damaged or is not such an entry.
  static std::optional<FurPageFile> open(const ContentStore& store, const ContentHash& key,
                                         const WarningSink& warn);
  /// Reads the table of a file, whatever the file's name. Throws Error (kInput) if the file is damaged or is
  /// not an entry of kind "fur" with this version.
  explicit FurPageFile(StoredSections file);

  const FurPageTable& table() const { return table_; }
  /// Bytes of memory that this object holds.
  size_t bytes() const {
    return file_.bytes() + table_.bytes() + first_treelet_.capacity() * sizeof(uint32_t);
  }

  /// Index of the first treelet of a page. The last treelet of the page precedes first_treelet(page + 1).
  uint32_t first_treelet(uint32_t page) const { return first_treelet_[page]; }
  /// Reads one page into `out`, which must be as long as the page and aligned to 64 bytes. Throws Error
  /// (kInput) when the page cannot be read, its checksum is wrong or a treelet cannot be traced.
  void read(uint32_t page, std::span<std::byte> out) const;
  /// Announces that a page will be read next, so that the system may load it.
  void prefetch(uint32_t page) const { file_.prefetch(page); }
  /// Reads and verifies all pages. Returns whether all pages are intact; if not, calls `warn` once.
  bool check_all(const Workers& workers, const WarningSink& warn) const;

 private:
  template <class T>
  std::vector<T> values(size_t section) const;

  StoredSections file_;
  FurPageTable table_;
  std::vector<uint32_t> first_treelet_;
};

}  // namespace pelage
