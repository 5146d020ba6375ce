// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pelage {

/// One kind of code of all strands of a leaf: `elements` numbers of `element_bytes` bytes for each. Strands
/// that have the same codes share an entry of a table where that takes less room. Nothing is lost either way,
/// so the form may depend on which strands share a leaf.
struct CodeColumn {
  enum class Form : uint8_t {
    kAbsent,  ///< the leaf does not hold it
    kOne,     ///< all strands have the entry of the table
    kByte,    ///< the number of each strand's entry, in 8 bits
    kShort,   ///< in 16 bits
    kRaw,     ///< rows over strands, one per element
  };
  Form form = Form::kAbsent;
  uint8_t element_bytes = 2;
  uint16_t elements = 1;  ///< of an entry of the table
  std::span<const std::byte> table;

  size_t entry_bytes() const { return size_t(element_bytes) * elements; }
  size_t entry_count() const { return table.size() / entry_bytes(); }
  /// Bytes of a block with rows of `row` strands that have `own_elements` elements.
  size_t block_bytes(size_t row, size_t own_elements) const;
  /// Whether the strands of a block name entries that there are.
  bool names_entries(const std::byte* block, size_t count) const;
  /// The entries of the first strands of a block; not for kAbsent and kRaw.
  void indices(const std::byte* block, size_t count, uint16_t* out) const;

  /// What of a leaf's strands is to be written, in their order: `entries` of entry_bytes() each.
  struct Choice {
    Form form = Form::kAbsent;
    std::vector<std::byte> table;
    std::vector<uint16_t> indices;  ///< of kByte and kShort, one per strand
  };
  static Choice choose(std::span<const std::byte> entries, size_t entry_bytes);
};

}  // namespace pelage
