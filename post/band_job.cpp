// SPDX-License-Identifier: Apache-2.0
#include "post/band_job.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr int kFewestRows = 16;
/// Larger bands are not faster, and their memory has to be allocated first.
constexpr int64_t kEnoughBytes = int64_t{256} << 20;

constexpr int64_t kMebibyte = int64_t{1} << 20;

/// `needed`: bytes, rounded up so that it is enough.
[[noreturn]] void fail_memory(const std::filesystem::path& path, const char* needs, int64_t needed,
                              int64_t budget) {
  throw Error(ErrorKind::kMemory, {path.string(), 0, 0},
              fmt::format("needs {} {} MiB of memory, but the budget is {:.6g} MiB", needs,
                          needed / kMebibyte + 1, static_cast<double>(budget) / kMebibyte));
}

void report_vectors(const VectorSurvey& survey, const ViewImage& image, const VectorParams& params,
                    const std::string& flag, const std::string& where, PostReport& report) {
  if (survey.not_finite() > 0) {
    report.notes.push_back(
        fmt::format("{} vectors{} are not finite and are treated as zero", survey.not_finite(), where));
  }
  const ExrPart& part = image.reader().parts()[image.channels()[image.own().front()].part];
  const bool is_ours = part.attributes.contains("pelage:version");
  const auto warning = survey.warning(params, flag, part.display.width(), is_ours);
  if (warning) report.warnings.push_back(*warning + where);
}

}  // namespace

PostSource::PostSource(const std::filesystem::path& path, int threads)
    : reader(path, threads), channels(name_channels(reader.parts())) {
  if (channels.empty()) throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "has no channels");
}

void check_field_memory(const ViewImage& image, int64_t held, int64_t budget) {
  const int64_t pixels = int64_t{image.canvas().width()} * image.canvas().height();
  // With a mark, and whether its edge is soft.
  const int64_t needed = held + pixels * static_cast<int64_t>(FlowField::kBytesPerPixel + 2);
  if (needed > budget) fail_memory(image.reader().path(), "more than", needed, budget);
}

void check_named_layers(const std::vector<MovingView>& views, const LayerChoice& choice) {
  for (const auto* names : {&choice.data, &choice.colors}) {
    for (const std::string& name : *names) {
      const bool is_known = std::any_of(
          views.begin(), views.end(), [&](const MovingView& view) { return view.image->layers().has(name); });
      if (is_known) continue;
      fail_missing(*views.front().image, "layer " + quote(name),
                   names == &choice.data ? "check --data-layer" : "check --color-layer");
    }
  }
}

std::vector<Flow> read_layer_vectors(const ViewImage& image, std::pair<size_t, size_t> layer,
                                     const VectorParams& params, const std::string& flag,
                                     const std::string& where, PostReport& report) {
  VectorSurvey survey(static_cast<float>(image.largest_reach()));
  std::vector<Flow> vectors = image.read_vectors(layer, params, survey);
  report_vectors(survey, image, params, flag, where, report);
  return vectors;
}

std::string layer_label(const std::string& what, const std::string& name) {
  return name.empty() ? what : what + " " + quote(name);
}

void fail_missing(const ViewImage& image, const std::string& what, const std::string& advice) {
  throw Error(ErrorKind::kInput, {image.reader().path().string(), 0, 0},
              fmt::format("has no {}; {}; it has {}", what, advice, image.layers().listing()));
}

WarpTarget BandJob::target(const MovingView& view) const {
  return {scale, window.x0 - view.image->canvas().x0, window.y0 - view.image->canvas().y0,
          static_cast<float>(longest_fill)};
}

int64_t BandJob::fixed_bytes() const {
  return scratch_bytes + 2 * source_.reader.buffer_bytes() + field_bytes();  // reads and writes
}

int64_t BandJob::field_bytes() const {
  int64_t bytes = 0;
  for (const MovingView& view : views) {
    if (!view.field) continue;
    bytes +=
        int64_t{view.field->width()} * view.field->height() * static_cast<int64_t>(FlowField::kBytesPerPixel);
  }
  return bytes;
}

int64_t BandJob::band_bytes(Band band) const {
  const int64_t planes = static_cast<int64_t>(source_.channels.size() + extra_planes);
  // A result in floats, and in halves while it is written.
  int64_t bytes = planes * window.width() * (band.last - band.first) * 6;
  int64_t max_source = 0;  // one view at a time
  for (const MovingView& view : views) {
    const RowRange rows = reach(view, target(view), band);
    max_source = std::max(max_source, int64_t{4} * view.image->canvas().width() * (rows.last - rows.first) *
                                          static_cast<int64_t>(view.image->own().size()));
  }
  return bytes + max_source;
}

BandJob::Band BandJob::next_band(int first) const {
  const int64_t room = memory - fixed_bytes();
  for (int rows = window.height() - first;; rows = (rows + 1) / 2) {
    const Band band{first, first + rows};
    const int64_t needed = band_bytes(band);
    if (needed <= std::min(room, kEnoughBytes)) return band;
    if (rows > kFewestRows) continue;
    if (needed <= room) return band;
    fail_memory(source_.reader.path(), "about", fixed_bytes() + needed, memory);
  }
}

Plane BandJob::plane(size_t number, Band band) const {
  const auto width = static_cast<size_t>(window.width()), rows = static_cast<size_t>(band.last - band.first);
  return {const_cast<float*>(result_.data()) + number * width * rows, 1, static_cast<ptrdiff_t>(width),
          band.first};
}

Plane BandJob::extra_plane(size_t extra) const { return plane(source_.channels.size() + extra, band_); }

void BandJob::make_band(Band band) {
  band_ = band;
  const size_t planes = source_.channels.size() + extra_planes;
  result_.assign(planes * static_cast<size_t>(window.width()) * static_cast<size_t>(band.last - band.first),
                 0);
  for (const MovingView& view : views) {
    const std::vector<size_t>& own = view.image->own();
    const RowRange rows = reach(view, target(view), band);
    view.image->read(own, rows.first, rows.last, pixels_);
    const auto width = static_cast<size_t>(view.image->canvas().width());
    const size_t plane_size = width * static_cast<size_t>(rows.last - rows.first);
    PostLayers layers;
    std::vector<size_t> number(source_.channels.size());
    for (size_t i = 0; i < own.size(); ++i) {
      number[own[i]] = i;
      layers.channels.push_back(
          {view.image->layers().role(own[i]),
           {pixels_.data() + i * plane_size, 1, static_cast<ptrdiff_t>(width), rows.first},
           plane(own[i], band)});
    }
    for (RankedMatte matte : view.image->layers().mattes()) {
      for (auto& rank : matte.ranks) rank = {number[rank.id], number[rank.coverage]};
      layers.mattes.push_back(std::move(matte));
    }
    process(view, target(view), band, layers);
  }
}

void BandJob::write_band(ExrWriter& writer, Band band, const Workers& workers) {
  for (size_t p = 0; p < parts.size(); ++p) {
    const PixelBox& data = parts[p].part.header.data;
    const int first = std::max(band.first, data.y0 - window.y0),
              last = std::min(band.last, data.y1 - window.y0);
    if (first >= last) continue;
    std::vector<ExrRows> rows;
    for (size_t c = 0; c < parts[p].planes.size(); ++c) {
      const Plane from = plane(parts[p].planes[c], band);
      rows.push_back({c, &from.at(data.x0 - window.x0, first), static_cast<size_t>(window.width())});
    }
    writer.write(p, last - first, rows, workers);
  }
}

void BandJob::run(const std::filesystem::path& output, const Job& job, PostReport& report) {
  std::vector<ExrOutputPart> headers;
  for (const Part& part : parts) headers.push_back(part.part);
  next_band(0);  // rejects a budget that is too small before writing anything
  ExrWriter writer(output, source_.reader, std::move(headers), job.workers.thread_count());
  const MemoryCharge fixed(job.ledger, MemoryTag::kFilm, fixed_bytes());
  report.bands = 0;
  report.window = window;
  for (int row = 0; row < window.height(); row = band_.last) {
    const Band band = next_band(row);
    const MemoryCharge charge(job.ledger, MemoryTag::kFilm, band_bytes(band));
    make_band(band);
    report.cancelled = job.progress.cancelled();
    if (report.cancelled) return;
    write_band(writer, band, job.workers);
    ++report.bands;
  }
  writer.commit();
}

}  // namespace pelage
