// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pelage {

/// One kind of code for all strands of a leaf: `elements` numbers of `element_bytes` bytes each. Strands with
/// equal codes share an entry of a table where that is smaller. The encoding is lossless, so the form may
/// depend on which strands share a leaf.
struct CodeColumn {
  enum class Form : uint8_t {
    kAbsent,  ///< not stored for this leaf
    kOne,     ///< all strands have the single entry of the table
    kByte,    ///< index of each strand's entry, in 8 bits
    kShort,   ///< in 16 bits
    kRaw,     ///< rows over strands, one per element
  };
  Form form = Form::kAbsent;
  uint8_t element_bytes = 2;
  uint16_t elements = 1;  ///< per entry of the table
  std::span<const std::byte> table;

  size_t entry_bytes() const { return size_t(element_bytes) * elements; }
  size_t entry_count() const { return table.size() / entry_bytes(); }
  /// Bytes of a block with rows for `row` strands that have `own_elements` elements.
  size_t block_bytes(size_t row, size_t own_elements) const;
  /// Whether all indices of a block are valid.
  bool names_entries(const std::byte* block, size_t count) const;
  /// Indices of the first strands of a block; not for kAbsent and kRaw.
  void indices(const std::byte* block, size_t count, uint16_t* out) const;

  /// The data to write for a leaf's strands, in their order: `entries` of entry_bytes() each.
  struct Choice {
    Form form = Form::kAbsent;
    std::vector<std::byte> table;
    std::vector<uint16_t> indices;  ///< of kByte and kShort, one per strand
  };
  static Choice choose(std::span<const std::byte> entries, size_t entry_bytes);
};

}  // namespace pelage
