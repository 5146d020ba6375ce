// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "cli/info.h"
#include "groom/cache/frozen_leaf.h"

namespace pelage {
namespace {

// Bytes per strand, for the largest parts.
std::string describe_column(const FrozenLeaf& leaf, StrandCodes::Column kind) {
  const CodeColumn& column = leaf.column(kind);
  switch (column.form) {
    case CodeColumn::Form::kAbsent:
      return "not stored";
    case CodeColumn::Form::kOne:
      return "one value for all strands";
    case CodeColumn::Form::kByte:
    case CodeColumn::Form::kShort:
      return fmt::format("one {} per strand", column.entry_count());
    case CodeColumn::Form::kRaw:
      return "one per strand";
  }
  return "";
}

// The first section describes all leaves; each of the others is one leaf.
std::string describe_offsets(const StoredFile& file) {
  static constexpr std::pair<StrandCodes::Column, const char*> kColumns[] = {
      {StrandCodes::kWidthScale, "widths"},           {StrandCodes::kWidthProfile, "width profile"},
      {StrandCodes::kColorScale, "brightness"},       {StrandCodes::kColorHue, "hue"},
      {StrandCodes::kColorProfile, "colour profile"}, {StrandCodes::kClump, "clumps"}};
  size_t strands = 0, points = 0, bytes = 0, plain = 0;
  std::string first_leaf;
  for (size_t i = 1; i < file.section_count(); ++i) {
    const std::optional<FrozenLeaf> leaf = FrozenLeaf::read(file.section(i));
    if (!leaf) return "  cannot read its chunks\n";
    strands += leaf->strand_count();
    bytes += leaf->bytes();
    for (const FrozenLeaf::Block& block : leaf->blocks()) {
      points += block.count * static_cast<size_t>(block.points);
      if (block.plain) plain += block.count;
    }
    if (i > 1) continue;
    for (const auto& [kind, name] : kColumns)
      first_leaf += fmt::format("    {}: {}\n", name, describe_column(*leaf, kind));
  }
  std::string text =
      fmt::format("  {} strands, {} points, in {} chunks\n", strands, points, file.section_count() - 1);
  if (strands)
    text +=
        fmt::format("  {:.1f} bytes per strand\n", static_cast<double>(bytes) / static_cast<double>(strands));
  if (!first_leaf.empty()) text += "  in the first chunk:\n" + first_leaf;
  if (plain)
    text += fmt::format("  {} strands stored as floats, because they or their neighbours are long and thin\n",
                        plain);
  return text;
}

// Text that is safe for a terminal.
std::string describe_manifest(std::span<const std::byte> bytes) {
  std::string text = "  ";
  for (std::byte b : bytes) {
    const auto c = static_cast<char>(b);
    if (c == '\n') {
      text += "\n  ";
    } else {
      text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  text.resize(text.size() - 2);
  return text;
}

}  // namespace

std::string describe_cache(const StoredFile& file) {
  std::string kind;
  for (char c : file.kind()) kind += c > 0x20 && c < 0x7f ? c : '?';
  std::string text = fmt::format("cache file: {}, {} bytes in {} sections\n  made from {}\n", kind,
                                 file.file_bytes(), file.section_count(), to_string(file.key()));
  if (kind == "offsets" && file.section_count() > 0) return text + describe_offsets(file);
  if (kind == "manifest" && file.section_count() == 1) return text + describe_manifest(file.section(0));
  return text;
}

}  // namespace pelage
