// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/hash.h"
#include "base/mapped_file.h"
#include "base/stored_sections.h"

namespace pelage {

class Lease;

/// Called with one line of text for each problem that does not stop the run.
using WarningSink = std::function<void(const std::string& line)>;

/// A memory-mapped file of a content store: a few sections of bytes, each aligned to 64 bytes. All bytes have
/// been verified against their checksums.
class StoredFile {
 public:
  /// Maps and verifies a file, which may have any name. Throws Error (kInput) with the reason when the file
  /// cannot be read or is damaged.
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

/// Returns whether a regular file starts with the magic number of content store files.
bool is_stored_file(const std::filesystem::path& path);

/// A folder of files, called entries, that hold results which can be computed again. The name of an entry is
/// its kind and the content hash of the inputs of the result (its key).
///
/// A file appears completely or not at all. An entry is accepted only if format, kind, key, length and all
/// checksums are correct (law 6). Any other file counts as missing, and the caller gets one warning. Symbolic
/// links to entries are never followed, neither for reading nor for writing; the folder itself may be a
/// symbolic link. A file of another user counts as missing too, unless this user is root or the folder is
/// declared shared (is_shared_folder()). File system errors never throw: a store that cannot be written
/// behaves as if it were empty. A `kind` has at most 16 characters: lower-case letters, digits and '-'.
/// Thread safety: const members may be called from any thread and by many processes.
class ContentStore {
 public:
  /// The folder need not exist.
  explicit ContentStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  /// Returns the path of an entry, whether or not it exists.
  std::filesystem::path file(const std::string& kind, const ContentHash& key) const;

  /// Opens an entry and verifies all its sections. Returns an empty value if the entry is missing, damaged or
  /// owned by an untrusted user, and calls `warn` in the last two cases. Records the use of the entry: sets
  /// the modification time of its file to now if the file was modified more than an hour ago.
  std::optional<StoredFile> open(const std::string& kind, const ContentHash& key,
                                 const WarningSink& warn) const;
  /// Opens an entry as open() does, but verifies only its header and table. StoredSections::read() verifies
  /// each section when it reads the section.
  std::optional<StoredSections> open_sections(const std::string& kind, const ContentHash& key,
                                              const WarningSink& warn) const;

  /// Writes one entry, section by section. The entry exists once commit() has returned true. After the first
  /// failure, nothing more is written, and commit() reports this failure to `warn`.
  class Writer {
   public:
    /// Writes to any path, for StoredFile(path). Replaces a link at this path.
    Writer(const std::filesystem::path& path, const std::string& kind, const ContentHash& key);
    /// Writes the next section.
    void add(std::span<const std::byte> section);
    template <class T>
    void add(std::span<const T> values) {
      add(std::as_bytes(values));
    }
    /// Whether writing has failed.
    bool failed() const { return !failure_.empty(); }
    /// Completes the entry. Returns true if the entry now exists, false after a failure.
    bool commit(const WarningSink& warn);

   private:
    struct Section {
      uint64_t offset = 0, bytes = 0;
      ContentHash hash;
    };
    void put(std::span<const std::byte> bytes);
    void attempt(const std::function<void()>& step);

    std::optional<AtomicFile> file_;
    std::string failure_;
    uint64_t written_ = 0;
    std::vector<Section> sections_;
  };
  Writer writer(const std::string& kind, const ContentHash& key) const;
  /// Writes an entry with all its sections. Returns true if the entry now exists, false after a failure.
  bool store(const std::string& kind, const ContentHash& key,
             std::span<const std::span<const std::byte>> sections, const WarningSink& warn) const;

  /// A lock on one entry: a Lease. The process (or thread) that computes the entry holds the lock.
  class Lock {
   public:
    Lock(Lock&& other) noexcept;
    ~Lock();
    /// Whether lock() obtained the lock. False when the folder cannot be written, the timeout expired or the
    /// wait was cancelled. Two processes may then compute the same entry, with the same result.
    bool held() const { return lease_ != nullptr; }

   private:
    friend class ContentStore;
    explicit Lock(std::unique_ptr<Lease> lease);
    std::unique_ptr<Lease> lease_;
  };
  /// Locks an entry. Waits until no process of any machine holds the lock, `patience` has passed or
  /// `cancelled` returns true; see Lock::held(). Afterwards, try to open the entry again, because another
  /// process may have stored the entry meanwhile. The lock of a process that dies is released at once on its
  /// own machine, and expires after half a minute for other machines.
  Lock lock(
      const std::string& kind, const ContentHash& key,
      const std::function<bool()>& cancelled = [] { return false; },
      std::chrono::milliseconds patience = std::chrono::hours(1)) const;

  /// Removes what processes leave behind when they are killed: their temporary files (see
  /// sweep_temporaries()), and lock files that have not been modified for longer than `age`.
  void sweep(std::chrono::seconds age = std::chrono::hours(1)) const;

  /// Argument for prune() after storing an entry: removes entries that have not been used for 30 days.
  static constexpr std::chrono::hours kUnusedAge{24 * 30};

  struct Removed {
    size_t files = 0;
    uint64_t bytes = 0;
  };
  /// Removes entries that have not been written or opened for longer than `age`, except for entries whose
  /// file name occurs in `keep`. Safe while other processes use the folder: open files stay readable, and an
  /// entry that is needed after its removal is computed again.
  Removed prune(std::chrono::seconds age, std::span<const std::filesystem::path> keep = {}) const;
  /// Removes the entries that have not been written or opened for longest, until all entries together take at
  /// most `max_bytes`. The time of use is that of open(), to the hour.
  Removed shrink(uint64_t max_bytes) const;
  /// Removes one file if it has the name of an entry and was not written or opened for longer than `age`.
  static Removed remove_unused(const std::filesystem::path& file, std::chrono::seconds age);

 private:
  bool trusts(uid_t owner) const;
  std::vector<std::filesystem::path> entries() const;
  template <class File>
  std::optional<File> open_as(const std::string& kind, const ContentHash& key, const WarningSink& warn) const;

  std::filesystem::path folder_;
};

}  // namespace pelage
