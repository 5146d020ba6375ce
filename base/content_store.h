// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/hash.h"
#include "base/mapped_file.h"
#include "base/stored_sections.h"

namespace pelage {

/// Takes one line about what went wrong and did not stop the run.
using WarningSink = std::function<void(const std::string& line)>;

/// A file of a content store, mapped: a few sections of bytes, each 64-byte aligned in memory. Every byte has
/// been checked against its checksum.
class StoredFile {
 public:
  /// Reads and checks a file by itself, whatever its name. Throws Error (kInput) that says what is wrong.
  explicit StoredFile(const std::filesystem::path& path) : StoredFile(OpenFile(path)) {}
  explicit StoredFile(const OpenFile& file);

  const std::string& kind() const { return kind_; }
  const ContentHash& key() const { return key_; }
  size_t section_count() const { return sections_.size(); }
  std::span<const std::byte> section(size_t i) const { return sections_[i]; }
  size_t file_bytes() const { return file_.bytes().size(); }

 private:
  MappedFile file_;
  std::string kind_;
  ContentHash key_;
  std::vector<std::span<const std::byte>> sections_;
};

/// Whether a file begins as those of content stores do.
bool is_stored_file(const std::filesystem::path& path);

/// Files named by kind and content hash in one folder: what was computed once and may be computed again.
///
/// A file appears whole or not at all, and a reader believes only one that is of this format, of the kind and
/// key that it asked for, as long as it says, and whose every section has its checksum (law 6). Everything
/// else counts as absent, with one warning. A symbolic link is never followed, neither to read nor to write
/// (the folder itself may be one), and a file of another user counts as absent too, unless that user is root
/// or the folder is shared by name (is_shared_folder()). Nothing here throws for what the file system does: a
/// store that cannot be written is one that remembers nothing. `kind` is of lower-case letters, digits and
/// '-', at most 16 characters. Thread safety: const members may be called from any thread and by many
/// processes.
class ContentStore {
 public:
  /// The folder need not exist.
  explicit ContentStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  /// Where an entry stands or would stand.
  std::filesystem::path file(const std::string& kind, const ContentHash& key) const;

  /// Nothing when there is no such entry, or a damaged or foreign one: then `warn` has been told. The time of
  /// the file becomes that of its last use, to the hour.
  std::optional<StoredFile> open(const std::string& kind, const ContentHash& key,
                                 const WarningSink& warn) const;
  /// The same of an entry whose sections are read one by one: each is checked when it is read.
  std::optional<StoredSections> open_sections(const std::string& kind, const ContentHash& key,
                                              const WarningSink& warn) const;

  /// Writes one entry, section by section; it exists from commit() on. After the first failure nothing more
  /// is written and commit() says what was wrong, once, to `warn`.
  class Writer {
   public:
    void add(std::span<const std::byte> section);
    template <class T>
    void add(std::span<const T> values) {
      add(std::as_bytes(values));
    }
    /// Whether nothing more can come of it.
    bool failed() const { return !failure_.empty(); }
    /// Whether the entry now exists.
    bool commit(const WarningSink& warn);

   private:
    friend class ContentStore;
    struct Section {
      uint64_t offset = 0, bytes = 0;
      ContentHash hash;
    };
    Writer(const std::filesystem::path& path, const std::string& kind, const ContentHash& key);
    void put(std::span<const std::byte> bytes);
    void attempt(const std::function<void()>& step);

    std::optional<AtomicFile> file_;
    std::string failure_;
    uint64_t written_ = 0;
    std::vector<Section> sections_;
  };
  Writer writer(const std::string& kind, const ContentHash& key) const;
  /// All sections at once. Whether the entry now exists.
  bool store(const std::string& kind, const ContentHash& key,
             std::span<const std::span<const std::byte>> sections, const WarningSink& warn) const;

  /// Held by the one process (or thread) that is about to compute an entry.
  class Lock {
   public:
    Lock(Lock&& other) noexcept;
    ~Lock();
    /// Whether it is held: not where the folder cannot be written or patience ran out. Then the work may be
    /// done twice; the result is the same.
    bool held() const { return descriptor_ >= 0; }

   private:
    friend class ContentStore;
    Lock() = default;
    int descriptor_ = -1;
    std::filesystem::path path_;
  };
  /// Waits until nobody else computes this entry, patience runs out or `cancelled` says so. Open it again
  /// afterwards: it may be there now. A process that dies gives its locks back.
  Lock lock(
      const std::string& kind, const ContentHash& key,
      const std::function<bool()>& cancelled = [] { return false; },
      std::chrono::milliseconds patience = std::chrono::minutes(2)) const;

  /// Removes what processes that were killed have left half-written: their temporary files
  /// (sweep_temporaries()), and locks that have not been touched for `age`.
  void sweep(std::chrono::seconds age = std::chrono::hours(1)) const;

  /// What nothing has used for so long goes whenever something is stored.
  static constexpr std::chrono::hours kUnusedAge{24 * 30};

  struct Removed {
    size_t files = 0;
    uint64_t bytes = 0;
  };
  /// Removes entries that nobody has written or opened for `age`, but for the files in `keep`. Safe beside
  /// processes that use the folder: who has a file open keeps it, who comes later makes it again.
  Removed prune(std::chrono::seconds age, std::span<const std::filesystem::path> keep = {}) const;
  /// The same for one file.
  static Removed remove_unused(const std::filesystem::path& file, std::chrono::seconds age);

 private:
  bool trusts(uid_t owner) const;
  template <class File>
  std::optional<File> open_as(const std::string& kind, const ContentHash& key, const WarningSink& warn) const;

  std::filesystem::path folder_;
};

}  // namespace pelage
