// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/open_file.h"

namespace pelage {

/// A whole file mapped into memory, read-only. Its pages are loaded on access and may be evicted by the
/// system, so they are not charged to the ledger (law 5). The file must not be truncated while it is mapped.
/// Therefore map only files that writers replace by renaming a new file. Thread safety: const members may be
/// called from any thread.
class MappedFile {
 public:
  MappedFile() = default;
  /// Throws Error (kInput) when `path` cannot be read or is not a regular file.
  explicit MappedFile(const std::filesystem::path& path) : MappedFile(OpenFile(path)) {}
  /// Throws Error (kInput) when the system cannot map the file.
  explicit MappedFile(const OpenFile& file);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace pelage
