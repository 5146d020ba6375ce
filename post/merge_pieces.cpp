// SPDX-License-Identifier: Apache-2.0
#include "post/merge_pieces.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/progress_stage.h"
#include "image/exr_file.h"
#include "post/uncovered.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

constexpr int kBandRows = 32;  // a multiple of the rows that OpenEXR compresses together
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

/// A piece and, while its rows are read, its reader.
struct Piece {
  fs::path path;
  ExrPart part;
  std::unique_ptr<ExrReader> reader;
};

Piece read_header(const fs::path& path) {
  const ExrReader reader(path);
  if (reader.parts().size() != 1)
    refuse(path, fmt::format("has {} parts, expected one", reader.parts().size()));
  Piece piece{path, reader.parts().front(), nullptr};
  const auto partial = piece.part.attributes.find(std::string(kPartial));
  if (partial != piece.part.attributes.end() && partial->second != ExrAttribute(0))
    refuse(path, "is partial: its render was interrupted");
  return piece;
}

void check_attribute(const Piece& first, const Piece& piece, const std::string& name) {
  const auto a = first.part.attributes.find(name), b = piece.part.attributes.find(name);
  const bool has_a = a != first.part.attributes.end(), has_b = b != piece.part.attributes.end();
  if (has_a && has_b && a->second == b->second) return;
  refuse(piece.path,
         fmt::format("`{}` is {}, but {} in {}{}", name, has_b ? text_of(b->second) : "missing",
                     has_a ? text_of(a->second) : "missing", first.path.string(), meaning_of(name)));
}

void check_alike(const Piece& first, const Piece& piece, const MergeParams& params) {
  const auto counts = [&](const std::string& name) {
    return name != kName && name != kSeconds && name != kPeak &&
           (name != kInstructions || !params.any_instructions);
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

void check_coverage(const std::vector<Piece>& pieces) {
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
const T* value_of(const Piece& piece, std::string_view name) {
  const auto found = piece.part.attributes.find(std::string(name));
  return found == piece.part.attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

ExrPart merged_header(const std::vector<Piece>& pieces) {
  ExrPart header = pieces.front().part;
  header.data = header.display;
  float seconds = 0;
  int64_t peak = 0;
  bool mixed = false;
  const std::string* first = value_of<std::string>(pieces.front(), kInstructions);
  for (const Piece& piece : pieces) {
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

/// Copies the rows y0 .. y1 - 1 of a piece to the planes of a band of `frame`.
void copy_rows(Piece& piece, const PixelBox& frame, int y0, int y1, int threads,
               std::vector<std::vector<float>>& planes) {
  const PixelBox& box = piece.part.data;
  const int from = std::max(y0, box.y0), to = std::min(y1, box.y1);
  if (from >= to) return;
  if (!piece.reader) piece.reader = std::make_unique<ExrReader>(piece.path, threads);
  if (piece.reader->parts().size() != 1 || piece.reader->parts().front().data != box)
    refuse(piece.path, "changed while it was read");
  const auto width = static_cast<size_t>(frame.width());
  const size_t first = static_cast<size_t>(from - y0) * width + static_cast<size_t>(box.x0 - frame.x0);
  std::vector<ExrRows> rows;
  for (size_t c = 0; c < planes.size(); ++c) rows.push_back({c, planes[c].data() + first, width});
  piece.reader->read(0, from, to, rows);
  if (to == box.y1) piece.reader = nullptr;
}

}  // namespace

PixelBox merge_pieces(const std::vector<fs::path>& paths, const fs::path& output, const MergeParams& params,
                      const Job& job) {
  std::vector<Piece> pieces;
  for (const fs::path& path : paths) {
    pieces.push_back(read_header(path));
    check_alike(pieces.front(), pieces.back(), params);
  }
  if (pieces.empty()) throw Error(ErrorKind::kArguments, "no pieces to merge");
  check_coverage(pieces);

  const ExrPart header = merged_header(pieces);
  const PixelBox& frame = header.data;
  const int threads = job.workers.thread_count();
  const auto width = static_cast<size_t>(frame.width());
  std::vector<std::vector<float>> planes(header.channels.size(),
                                         std::vector<float>(width * static_cast<size_t>(kBandRows)));
  const ExrReader like(paths.front());
  ExrWriter writer(output, like, {{0, header}}, threads);
  const ProgressStage stage(job.progress, "merge", static_cast<double>(frame.height()));
  for (int y = frame.y0; y < frame.y1; y += kBandRows) {
    if (job.progress.cancelled()) return {};
    const int end = std::min(y + kBandRows, frame.y1);
    for (Piece& piece : pieces) copy_rows(piece, frame, y, end, threads, planes);
    std::vector<ExrRows> rows;
    for (size_t c = 0; c < planes.size(); ++c) rows.push_back({c, planes[c].data(), width});
    writer.write(0, end - y, rows, job.workers);
    job.progress.advance(static_cast<double>(end - y));
  }
  writer.commit();
  return frame;
}

}  // namespace pelage
