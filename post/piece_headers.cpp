// SPDX-License-Identifier: Apache-2.0
#include "post/piece_headers.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kName = "name", kSeconds = "pelage:renderSeconds",
                           kPeak = "pelage:peakMemoryBytes", kInstructions = "pelage:instructions",
                           kPartial = "pelage:partial";

/// Attributes with a meaning that an error message should tell.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kMeanings = {
    {{"pelage:sceneHash", "they show different scenes or settings"},
     {"pelage:version", "different versions of Pelage made them"},
     {kInstructions,
      "processors with different instructions made them, so the last digits may differ; "
      "--any-instructions accepts them"},
     {"pelage:samples", "they have different sample counts"},
     {"pelage:frame", "they belong to different frames"},
     {"pelage:seed", "they have different seeds"}}};

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, why);
}

std::string text_of(const PixelBox& box) {
  return fmt::format("{},{},{},{}", box.x0, box.y0, box.x1, box.y1);
}

std::string text_of(const ExrAttribute& attribute) {
  if (const int* number = std::get_if<int>(&attribute)) return fmt::format("{}", *number);
  if (const float* number = std::get_if<float>(&attribute)) return fmt::format("{}", *number);
  if (const std::string* text = std::get_if<std::string>(&attribute)) return "\"" + *text + "\"";
  return "another value";
}

std::string meaning_of(const std::string& attribute) {
  const auto found =
      std::find_if(kMeanings.begin(), kMeanings.end(), [&](const auto& m) { return m.first == attribute; });
  return found == kMeanings.end() ? "" : fmt::format("; {}", found->second);
}

PieceHeader read_header(const fs::path& path) {
  const ExrReader reader(path);
  if (reader.parts().size() != 1)
    refuse(path, fmt::format("has {} parts, expected one", reader.parts().size()));
  PieceHeader piece{path, reader.parts().front()};
  const auto partial = piece.part.attributes.find(std::string(kPartial));
  if (partial != piece.part.attributes.end() && partial->second != ExrAttribute(0))
    refuse(path, "is partial: its render was interrupted");
  return piece;
}

void check_attribute(const PieceHeader& first, const PieceHeader& piece, const std::string& name) {
  const auto a = first.part.attributes.find(name), b = piece.part.attributes.find(name);
  const bool has_a = a != first.part.attributes.end(), has_b = b != piece.part.attributes.end();
  if (has_a && has_b && a->second == b->second) return;
  refuse(piece.path,
         fmt::format("`{}` is {}, but {} in {}{}", name, has_b ? text_of(b->second) : "missing",
                     has_a ? text_of(a->second) : "missing", first.path.string(), meaning_of(name)));
}

void check_alike(const PieceHeader& first, const PieceHeader& piece, bool any_instructions) {
  const auto counts = [&](const std::string& name) {
    return name != kName && name != kSeconds && name != kPeak && (name != kInstructions || !any_instructions);
  };
  if (piece.part.display != first.part.display)
    refuse(piece.path, fmt::format("is a piece of a picture {}, but {} of {}", text_of(piece.part.display),
                                   first.path.string(), text_of(first.part.display)));
  // The scene comes first: most other differences follow from it.
  for (const auto& [name, meaning] : kMeanings) {
    const std::string key(name);
    if (counts(key) && (first.part.attributes.contains(key) || piece.part.attributes.contains(key)))
      check_attribute(first, piece, key);
  }
  for (const auto* some : {&first, &piece}) {
    for (const auto& [name, value] : some->part.attributes) {
      if (counts(name)) check_attribute(first, piece, name);
    }
  }
  if (piece.part.channels != first.part.channels)
    refuse(piece.path, "has other channels than " + first.path.string());
}

void check_coverage(const std::vector<PieceHeader>& pieces) {
  const PixelBox& frame = pieces.front().part.display;
  std::vector<PixelBox> boxes;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const PixelBox& box = pieces[i].part.data;
    const PixelBox inside = common_pixels(box, frame);
    if (inside != box)
      refuse(pieces[i].path,
             fmt::format("pixels {} lie outside of the picture {}", text_of(box), text_of(frame)));
    for (size_t j = 0; j < i; ++j) {
      if (pieces[j].path == pieces[i].path) refuse(pieces[i].path, "is given twice");
      const PixelBox shared = common_pixels(box, boxes[j]);
      if (shared.width() > 0)
        refuse(pieces[i].path, fmt::format("contains pixels {}, which {} contains too", text_of(shared),
                                           pieces[j].path.string()));
    }
    boxes.push_back(box);
  }
  const std::vector<PixelBox> missing = uncovered_boxes(frame, boxes);
  if (missing.empty()) return;
  constexpr size_t kShown = 4;
  std::string text = text_of(missing.front());
  for (size_t i = 1; i < std::min(missing.size(), kShown); ++i) text += " and " + text_of(missing[i]);
  if (missing.size() > kShown) text += " and more";
  throw Error(ErrorKind::kInput, fmt::format("no piece contains the pixels {}", text));
}

/// Returns the value of an attribute; null if it is missing or has another type.
template <class T>
const T* value_of(const PieceHeader& piece, std::string_view name) {
  const auto found = piece.part.attributes.find(std::string(name));
  return found == piece.part.attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

}  // namespace

std::vector<PieceHeader> read_pieces(const std::vector<fs::path>& paths, bool any_instructions) {
  std::vector<PieceHeader> pieces;
  for (const fs::path& path : paths) {
    pieces.push_back(read_header(path));
    check_alike(pieces.front(), pieces.back(), any_instructions);
  }
  if (pieces.empty()) throw Error(ErrorKind::kArguments, "no pieces to merge");
  check_coverage(pieces);
  return pieces;
}

ExrPart merged_header(const std::vector<PieceHeader>& pieces) {
  ExrPart header = pieces.front().part;
  header.data = header.display;
  float seconds = 0;
  int64_t peak = 0;
  bool mixed = false;
  const std::string* first = value_of<std::string>(pieces.front(), kInstructions);
  for (const PieceHeader& piece : pieces) {
    if (const float* s = value_of<float>(piece, kSeconds)) seconds += *s;
    if (const std::string* p = value_of<std::string>(piece, kPeak))
      peak = std::max(peak, int64_t{std::atoll(p->c_str())});
    const std::string* instructions = value_of<std::string>(piece, kInstructions);
    mixed = mixed || (first && instructions && *first != *instructions);
  }
  const auto replace = [&](std::string_view name, const ExrAttribute& value) {
    const auto found = header.attributes.find(std::string(name));
    if (found != header.attributes.end()) found->second = value;
  };
  replace(kSeconds, seconds);
  replace(kPeak, std::to_string(peak));
  if (mixed) replace(kInstructions, "mixed");
  return header;
}

bool is_merged(const std::vector<fs::path>& paths, const fs::path& output, bool any_instructions) {
  std::error_code error;
  const auto written = fs::last_write_time(output, error);
  if (error) return false;
  for (const fs::path& path : paths) {
    const auto piece = fs::last_write_time(path, error);
    if (error || piece >= written) return false;
  }
  try {
    const ExrReader merged(output);
    if (merged.parts().size() != 1) return false;
    const ExrPart expected = merged_header(read_pieces(paths, any_instructions));
    const ExrPart& found = merged.parts().front();
    return found.data == expected.data && found.display == expected.display &&
           found.channels == expected.channels && found.attributes == expected.attributes;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace pelage
