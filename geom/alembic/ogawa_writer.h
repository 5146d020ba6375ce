// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/file.h"

namespace pelage {

/// Writes an Ogawa file (OgawaFile) to a new file: blocks of data and groups, each after the children that it
/// names. Members throw Error (kFailed) as AtomicFile does.
class OgawaWriter {
 public:
  /// Writes the header. The caller commits `file` after finish().
  explicit OgawaWriter(AtomicFile& file);

  /// Writes a block that consists of two parts, and returns its word for a group.
  uint64_t data(std::span<const std::byte> bytes, std::span<const std::byte> more = {});
  /// Begins a block of so many bytes, which append() then writes in parts. Returns its word.
  uint64_t begin(uint64_t size);
  void append(std::span<const std::byte> bytes) { file_.write(bytes); }
  /// Replaces bytes within a block. `offset`: from the beginning of its data.
  void replace(uint64_t block, uint64_t offset, std::span<const std::byte> bytes);
  /// Writes a group of such words, and returns its own.
  uint64_t group(std::span<const uint64_t> children);
  /// Completes the file. `root`: the word of the first group.
  void finish(uint64_t root);

 private:
  AtomicFile& file_;
  uint64_t end_ = 0;
};

}  // namespace pelage
