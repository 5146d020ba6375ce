// SPDX-License-Identifier: Apache-2.0
#include "post/blur_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "post/box_resolve.h"
#include "post/soft_edges.h"
#include "post/step_lists.h"

namespace pelage {
namespace {

/// `max`: pixels on each side.
PixelBox grown_within(const PixelBox& box, const Overhang& by, int max, const PixelBox& limits) {
  return {std::max(box.x0 - std::min(by.left, max), std::min(limits.x0, box.x0)),
          std::max(box.y0 - std::min(by.top, max), std::min(limits.y0, box.y0)),
          std::min(box.x1 + std::min(by.right, max), std::max(limits.x1, box.x1)),
          std::min(box.y1 + std::min(by.bottom, max), std::max(limits.y1, box.y1))};
}

void enclose(PixelBox& box, const PixelBox& other) {
  box = {std::min(box.x0, other.x0), std::min(box.y0, other.y0), std::max(box.x1, other.x1),
         std::max(box.y1, other.y1)};
}

std::string of_view(const std::string& view) { return view.empty() ? "" : " in view '" + view + "'"; }

float longest_of(const FlowField& field) {
  const float x = std::max(std::abs(field.low().x), std::abs(field.high().x));
  const float y = std::max(std::abs(field.low().y), std::abs(field.high().y));
  return std::hypot(x, y);
}

/// Warns if the header states that the picture is already blurred. Other programs' files do not state it.
void check_sharp(const ExrPart& part, PostReport& report) {
  const auto found = part.attributes.find("pelage:shutter");
  const V2f* shutter = found == part.attributes.end() ? nullptr : std::get_if<V2f>(&found->second);
  if (part.attributes.contains("pelage:motionBlur")) {
    report.warnings.push_back("the picture is already blurred: pelage motionblur wrote it");
  } else if (shutter && shutter->y > shutter->x) {
    report.warnings.push_back(
        fmt::format("the picture is already blurred: it was rendered with the shutter open from {:.3g} to "
                    "{:.3g} frames; render it with camera.shutter: [0, 0]",
                    static_cast<double>(shutter->x), static_cast<double>(shutter->y)));
  }
}

/// The field of a view, or null when it has no vectors or there is nothing to blur. `held`: bytes of previous
/// ones.
std::unique_ptr<FlowField> make_field(const ViewImage& image, const BlurFileParams& params,
                                      const std::string& view, int64_t held, const Workers& workers,
                                      PostReport& report) {
  const LayerFinder& layers = image.layers();
  const auto motion = layers.motion();
  if (!motion || !layers.has_colors()) return nullptr;
  const bool without_depth = params.file.layers.depth == "none";
  if (!layers.depth() && !without_depth) {
    fail_missing(image, layer_label("depth", params.file.layers.depth) + of_view(view),
                 "name a layer with --depth-layer, or 'none' to blur without depth");
  }
  check_field_memory(image, held, params.file.memory);
  std::vector<uint8_t> edges;
  std::vector<float> depth =
      image.read_depth(without_depth ? std::nullopt : layers.depth(), layers.alpha(), edges);
  std::vector<Flow> vectors =
      read_layer_vectors(image, *motion, params.file.vectors, "--motion", of_view(view), report);
  report.depth_hash = hash64(report.depth_hash, content_hash(std::as_bytes(std::span(depth))).low);
  join_soft_edges(image.canvas().width(), image.canvas().height(), edges, depth, vectors);
  const ShutterParams& shutter = params.shutter;
  LinkLimits limits;
  limits.largest_time = std::abs(shutter.centre) + std::abs(shutter.length) / 2;
  return std::make_unique<FlowField>(image.canvas().width(), image.canvas().height(), std::move(vectors),
                                     std::move(depth), limits, workers);
}

int64_t scratch_bytes(const BlurFileParams& params, size_t channels, int threads) {
  const PixelBox piece{0, 0, params.tiling.columns, params.tiling.rows};
  PostLayers layers;
  layers.channels.resize(channels);
  const size_t bytes =
      WorkBuffer::bytes_needed(piece, params.file.scale) +
      static_cast<size_t>(piece.width() * piece.height()) * BoxResolve::bytes_per_pixel(layers);
  return static_cast<int64_t>(bytes) * threads;
}

}  // namespace

PostReport blur_file(const std::filesystem::path& input, const std::filesystem::path& output,
                     const BlurFileParams& params, const Job& job) {
  PostReport report;
  PostSource source(input, job.workers.thread_count());
  ExrReader& reader = source.reader;
  const std::vector<NamedChannel>& channels = source.channels;
  check_sharp(reader.parts().front(), report);

  BandJob bands(source, params.file, kDefaultSeam);
  bands.scratch_bytes = scratch_bytes(params, channels.size(), job.workers.thread_count());
  for (const std::string& view : views_of(channels, reader.parts())) {
    MovingView moving;
    moving.image = std::make_unique<ViewImage>(reader, channels, view, params.file.layers);
    if (moving.image->own().empty()) continue;
    moving.field = make_field(*moving.image, params, view, bands.field_bytes(), job.workers, report);
    if (moving.field) report.longest = std::max(report.longest, longest_of(*moving.field));
    if (!moving.field && moving.image->layers().has_colors()) {
      report.notes.push_back("no motion vectors" + of_view(view) + ": copied");
    }
    bands.views.push_back(std::move(moving));
  }
  const auto moving =
      std::count_if(bands.views.begin(), bands.views.end(), [](const auto& v) { return !!v.field; });
  if (moving == 0) {
    const bool has_vectors = std::any_of(bands.views.begin(), bands.views.end(), [](const auto& v) {
      return v.image->layers().motion().has_value();
    });
    if (has_vectors) {
      fail_missing(*bands.views.front().image, "colours to blur", "name their layer with --color-layer");
    }
    fail_missing(*bands.views.front().image, layer_label("motion vectors", params.file.layers.motion),
                 "name their layer with --motion-layer");
  }
  check_named_layers(bands.views, params.file.layers);
  const std::vector<float> times = shutter_times(params.shutter, report.longest);
  report.steps = static_cast<int>(times.size());
  const float largest_time = std::max(std::abs(times.front()), std::abs(times.back()));
  if (std::any_of(bands.views.begin(), bands.views.end(), [&](const MovingView& view) {
        return view.field && StepLists::is_needed(*view.field, largest_time);
      })) {
    bands.scratch_bytes += static_cast<int64_t>(StepLists::bytes_needed()) * job.workers.thread_count();
  }

  bands.window = reader.parts().front().data;
  for (size_t p = 0; p < reader.parts().size(); ++p) {
    const ExrPart& part = reader.parts()[p];
    BandJob::Part out{{p, part}, {}};
    for (const MovingView& view : bands.views) {
      bool is_inside = false;
      for (size_t i : view.image->own()) is_inside |= channels[i].part == p;
      if (!is_inside || !view.field) continue;
      enclose(out.part.header.data, grown_within(part.data, overhang(*view.field, times),
                                                 view.image->largest_reach(), part.display));
    }
    for (size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].part == p) out.planes.push_back(i);
    }
    out.part.header.attributes.clear();  // the attributes of the source stay
    out.part.header.attributes["pelage:motionBlur"] =
        fmt::format("shutter {} around {}, {} steps, scale {}", params.shutter.length, params.shutter.centre,
                    report.steps, params.file.scale);
    if (part.attributes.contains("pelage:shutter")) {
      const float middle = params.shutter.centre, half = params.shutter.length / 2;
      out.part.header.attributes["pelage:shutter"] = V2f(middle - half, middle + half);
    }
    enclose(bands.window, out.part.header.data);
    bands.parts.push_back(std::move(out));
  }

  bands.reach = [&](const MovingView& view, const WarpTarget& target, BandJob::Band band) -> RowRange {
    if (view.field)
      return rows_reaching(*view.field, target, bands.window.width(), band.first, band.last, times);
    const int height = view.image->canvas().height();
    return {std::clamp(band.first + target.origin_y, 0, height),
            std::clamp(band.last + target.origin_y, 0, height)};
  };
  bands.process = [&](const MovingView& view, const WarpTarget& target, BandJob::Band band,
                      const PostLayers& layers) {
    if (view.field) {
      const BlurJob blur{view.field.get(), target, times, bands.window.width(), band.first, band.last};
      blur_rows(blur, layers, params.tiling, job.workers, job.progress);
      return;
    }
    const RowRange rows = bands.reach(view, target, band);
    for (const PostChannel& channel : layers.channels) {
      for (int y = rows.first; y < rows.last; ++y) {
        for (int x = 0; x < view.image->canvas().width(); ++x) {
          channel.target.at(x - target.origin_x, y - target.origin_y) = channel.source.at(x, y);
        }
      }
    }
  };
  job.progress.begin("blur", static_cast<double>(bands.window.height()) * static_cast<double>(moving));
  bands.run(output, job, report);
  job.progress.end();
  return report;
}

}  // namespace pelage
