// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pelage {

/// The codes of one kind for all strands of a leaf. A strand has `elements` integers of `element_bytes` bytes
/// each, its entry. Where that takes less space, each different entry is stored once in a table, and strands
/// with equal entries share it. The encoding is lossless. Its form may therefore depend on which strands
/// share a leaf.
struct CodeColumn {
  enum class Form : uint8_t {
    kAbsent,  ///< not stored for this leaf
    kOne,     ///< all strands have the same entry, the only one in the table
    kByte,    ///< 8-bit index into the table for each strand
    kShort,   ///< 16-bit index into the table for each strand
    kRaw,     ///< no table: the integers themselves, one row over strands per element
  };
  Form form = Form::kAbsent;
  uint8_t element_bytes = 2;
  uint16_t elements = 1;  ///< number of integers per entry of the table
  std::span<const std::byte> table;

  size_t entry_bytes() const { return size_t(element_bytes) * elements; }
  size_t entry_count() const { return table.size() / entry_bytes(); }
  /// Returns the bytes that this column takes in a block of strands. `row`: number of strands per row.
  /// `own_elements`: number of integers per strand in this block (kRaw only).
  size_t block_bytes(size_t row, size_t own_elements) const;
  /// Whether all indices of a block refer to existing entries of the table.
  bool names_entries(const std::byte* block, size_t count) const;
  /// Writes the table indices of the first `count` strands of a block to `out`. Not for kAbsent and kRaw.
  void indices(const std::byte* block, size_t count, uint16_t* out) const;

  /// The form and data in which to write the codes of a leaf's strands.
  struct Choice {
    Form form = Form::kAbsent;
    std::vector<std::byte> table;
    std::vector<uint16_t> indices;  ///< for kByte and kShort: table index of each strand
  };
  /// Chooses the smallest form for the entries of a leaf's strands: entry_bytes bytes per strand, in order of
  /// the strands.
  static Choice choose(std::span<const std::byte> entries, size_t entry_bytes);
};

}  // namespace pelage
