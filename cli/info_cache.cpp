// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "cli/info.h"
#include "groom/frozen_leaf.h"

namespace pelage {
namespace {

const char* name_of(FrozenClass kind) {
  switch (kind) {
    case FrozenClass::kNone:
      return "not kept";
    case FrozenClass::kConstant:
      return "the same for all strands";
    case FrozenClass::kSeparable:
      return "one profile, a factor per strand";
    case FrozenClass::kFull:
      return "of each point";
  }
  return "";
}

// The first section is about all leaves; each of the others is one.
std::string describe_offsets(const StoredFile& file) {
  std::string text;
  size_t strands = 0, points = 0, bytes = 0, wide = 0;
  FrozenClass widths = FrozenClass::kNone, colors = FrozenClass::kNone;
  for (size_t i = 1; i < file.section_count(); ++i) {
    const std::optional<FrozenLeaf> leaf = FrozenLeaf::read(file.section(i));
    if (!leaf) return "  its leaves cannot be read\n";
    strands += leaf->strand_count();
    bytes += leaf->bytes();
    wide += leaf->is_wide();
    for (const FrozenLeaf::Block& block : leaf->blocks())
      points += block.count * static_cast<size_t>(block.points);
    widths = std::max(widths, leaf->widths());
    colors = std::max(colors, leaf->colors());
  }
  text += fmt::format("  {} strands, {} points, in {} leaves\n", strands, points, file.section_count() - 1);
  if (strands)
    text +=
        fmt::format("  {:.1f} bytes per strand\n", static_cast<double>(bytes) / static_cast<double>(strands));
  text += fmt::format("  widths: {}\n  colours: {}\n", name_of(widths), name_of(colors));
  if (wide) text += fmt::format("  {} leaves in full precision: their strands are long and thin\n", wide);
  return text;
}

// Text that a terminal may have.
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
