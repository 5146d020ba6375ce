// SPDX-License-Identifier: Apache-2.0
#include "post/merge_pieces.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "image/exr_file.h"
#include "post/piece_headers.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

constexpr int kBandRows = 32;  // a multiple of the rows that OpenEXR compresses together

/// A piece and, while its rows are read, its reader.
struct Piece {
  fs::path path;
  PixelBox box;
  std::unique_ptr<ExrReader> reader;
};

/// Copies the rows y0 .. y1 - 1 of a piece to the planes of a band of `frame`.
void copy_rows(Piece& piece, const PixelBox& frame, int y0, int y1, int threads,
               std::vector<std::vector<float>>& planes) {
  const PixelBox& box = piece.box;
  const int from = std::max(y0, box.y0), to = std::min(y1, box.y1);
  if (from >= to) return;
  if (!piece.reader) piece.reader = std::make_unique<ExrReader>(piece.path, threads);
  if (piece.reader->parts().size() != 1 || piece.reader->parts().front().data != box)
    throw Error(ErrorKind::kInput, {piece.path.string(), 0, 0}, "changed while it was read");
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
  const std::vector<PieceHeader> headers = read_pieces(paths, params.any_instructions);
  const ExrPart header = merged_header(headers);
  std::vector<Piece> pieces;
  for (const PieceHeader& piece : headers) pieces.push_back({piece.path, piece.part.data, nullptr});
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
