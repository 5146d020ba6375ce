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

/// Receives one line about a problem that did not stop the run.
using WarningSink = std::function<void(const std::string& line)>;

/// A memory-mapped file of a content store: a few sections of bytes, each aligned to 64 bytes. All bytes have
/// been verified against their checksums.
class StoredFile {
 public:
  /// Reads and verifies a file, whatever its name. Throws Error (kInput) with the reason.
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

/// Whether a file starts with the magic number of content store files.
bool is_stored_file(const std::filesystem::path& path);

/// A folder of files named by kind and content hash: results that can be computed again.
///
/// A file appears completely or not at all. A reader accepts only files with the right format, kind, key and
/// length and with correct checksums of all sections (law 6); everything else counts as missing, with one
/// warning. Symbolic links are never followed, neither for reading nor for writing (the folder itself may be
/// one). A file of another user also counts as missing, unless that user is root or the folder is declared
/// shared (is_shared_folder()). File system errors never throw: a store that cannot be written behaves as if
/// it were empty. `kind`: lower-case letters, digits and '-', at most 16 characters. Thread safety: const
/// members may be called from any thread and by many processes.
class ContentStore {
 public:
  /// The folder need not exist.
  explicit ContentStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  /// Path of an entry, existing or not.
  std::filesystem::path file(const std::string& kind, const ContentHash& key) const;

  /// Returns nothing if the entry is missing, damaged or foreign. Calls `warn` for a damaged or foreign
  /// entry. Updates the modification time of the file to record its last use, with a resolution of one hour.
  std::optional<StoredFile> open(const std::string& kind, const ContentHash& key,
                                 const WarningSink& warn) const;
  /// The same for an entry whose sections are read one by one. Each section is verified when it is read.
  std::optional<StoredSections> open_sections(const std::string& kind, const ContentHash& key,
                                              const WarningSink& warn) const;

  /// Writes one entry, section by section; it exists after commit(). After the first failure nothing more is
  /// written, and commit() reports it once to `warn`.
  class Writer {
   public:
    void add(std::span<const std::byte> section);
    template <class T>
    void add(std::span<const T> values) {
      add(std::as_bytes(values));
    }
    /// Whether writing has failed.
    bool failed() const { return !failure_.empty(); }
    /// Returns whether the entry now exists.
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
  /// Writes all sections at once. Returns whether the entry now exists.
  bool store(const std::string& kind, const ContentHash& key,
             std::span<const std::span<const std::byte>> sections, const WarningSink& warn) const;

  /// A lock on one entry. The process (or thread) that computes the entry holds the lock.
  class Lock {
   public:
    Lock(Lock&& other) noexcept;
    ~Lock();
    /// Whether the lock is held: false when the folder cannot be written or the timeout expired. The work may
    /// then be done twice, with the same result.
    bool held() const { return descriptor_ >= 0; }

   private:
    friend class ContentStore;
    Lock() = default;
    int descriptor_ = -1;
    std::filesystem::path path_;
  };
  /// Waits until no other process computes this entry, the timeout expires or `cancelled` returns true. Open
  /// the entry again afterwards: it may exist now. The locks of a process that dies are released.
  Lock lock(
      const std::string& kind, const ContentHash& key,
      const std::function<bool()>& cancelled = [] { return false; },
      std::chrono::milliseconds patience = std::chrono::minutes(2)) const;

  /// Removes incomplete files of killed processes: temporary files (sweep_temporaries()), and locks that have
  /// not been touched for `age`.
  void sweep(std::chrono::seconds age = std::chrono::hours(1)) const;

  /// Storing an entry removes entries that have not been used for this time.
  static constexpr std::chrono::hours kUnusedAge{24 * 30};

  struct Removed {
    size_t files = 0;
    uint64_t bytes = 0;
  };
  /// Removes entries that have not been written or opened for `age`, except for the files in `keep`. Safe
  /// while other processes use the folder: open files stay readable, and entries removed too early are
  /// computed again.
  Removed prune(std::chrono::seconds age, std::span<const std::filesystem::path> keep = {}) const;
  /// The same for a single file.
  static Removed remove_unused(const std::filesystem::path& file, std::chrono::seconds age);

 private:
  bool trusts(uid_t owner) const;
  template <class File>
  std::optional<File> open_as(const std::string& kind, const ContentHash& key, const WarningSink& warn) const;

  std::filesystem::path folder_;
};

}  // namespace pelage
