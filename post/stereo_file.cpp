// SPDX-License-Identifier: Apache-2.0
#include "post/stereo_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"
#include "post/lanczos_resolve.h"
#include "post/soft_edges.h"

namespace pelage {
namespace {

const M44f* matrix(const ExrPart& part, const char* name) {
  const auto found = part.attributes.find(name);
  return found == part.attributes.end() ? nullptr : std::get_if<M44f>(&found->second);
}

/// From camera space to NDC; empty when the header does not contain it.
std::optional<Imath::M44d> projection(const ExrPart& part) {
  const M44f* camera = matrix(part, "worldToCamera");
  const M44f* ndc = matrix(part, "worldToNDC");
  if (!camera || !ndc) return {};
  const Imath::M44d to_camera(*camera);
  if (!(std::abs(to_camera.determinant()) > 1e-30)) return {};
  return to_camera.inverse() * Imath::M44d(*ndc);
}

constexpr float kEyeSeparationMetres = 0.065f;

[[noreturn]] void refuse(const ExrReader& reader, const std::string& why) {
  throw Error(ErrorKind::kInput, {reader.path().string(), 0, 0}, why);
}

std::string pick_view(const ExrReader& reader, const std::vector<std::string>& views,
                      const StereoFileParams& params) {
  const auto has = [&](const std::string& view) {
    return std::find(views.begin(), views.end(), view) != views.end();
  };
  if (params.view) {
    if (has(*params.view)) return *params.view;
    std::vector<std::string> named = views;
    std::erase(named, "");  // channels of no view
    refuse(reader, named.empty() ? "has no views"
                                 : "has no view " + quote(*params.view) + suggest(*params.view, named));
  }
  const std::string usual = params.to_left ? "right" : "left";
  return has(usual) ? usual : views.front();
}

/// The part that provides the camera: the first one of the view.
const ExrPart& camera_part(const ViewImage& image) {
  return image.reader().parts()[image.channels()[image.own().front()].part];
}

StereoCamera pick_camera(const ViewImage& image, const StereoFileParams& params) {
  const ExrPart& part = camera_part(image);
  StereoCamera camera;
  camera.convergence = params.convergence;
  if (params.focal_pixels) {
    camera.focal_pixels = *params.focal_pixels;
  } else if (params.fov_deg) {
    const float half = *params.fov_deg / 2 * std::numbers::pi_v<float> / 180;
    camera.focal_pixels = static_cast<float>(part.display.height()) / (2 * std::tan(half));
  } else if (const auto focal = focal_pixels_of(part)) {
    camera.focal_pixels = *focal;
  } else {
    refuse(image.reader(),
           "contains no camera (worldToCamera, worldToNDC); give --fov, --focal-pixels or --parallax-layer");
  }
  if (params.eye_separation) {
    camera.eye_separation = *params.eye_separation;
  } else {
    const auto unit = part.attributes.find("pelage:metersPerUnit");
    const float* metres = unit == part.attributes.end() ? nullptr : std::get_if<float>(&unit->second);
    if (!metres || !(*metres > 0))
      refuse(image.reader(), "does not give the length of a unit; give --eye-separation");
    camera.eye_separation = kEyeSeparationMetres / *metres;
  }
  if (params.to_left) camera.eye_separation = -camera.eye_separation;
  return camera;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = from.empty() ? std::string::npos : text.find(from);
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

std::string other_view(const std::string& view) {
  return view == "left" ? "right" : view == "right" ? "left" : view;
}

/// Parts of the result: those with channels of the view; the layer `invented` is added to the part with the
/// colours.
void plan_parts(BandJob& job, const ViewImage& image, const std::string& view, const StereoCamera& camera) {
  const ExrReader& reader = image.reader();
  const std::vector<NamedChannel>& channels = image.channels();
  // With the beauty if there is one, otherwise with the first colour.
  const auto first = [&](auto&& is_wanted) {
    const auto found = std::find_if(image.own().begin(), image.own().end(), is_wanted);
    return found == image.own().end() ? std::nullopt : std::optional(channels[*found].part);
  };
  const auto beauty = first([&](size_t i) { return channels[i].name() == "R"; });
  const auto any = first([&](size_t i) { return image.layers().role(i) == LayerRole::kColor; });
  const size_t colors = beauty.value_or(any.value_or(channels[image.own().front()].part));
  for (size_t p = 0; p < reader.parts().size(); ++p) {
    BandJob::Part out{{p, reader.parts()[p]}, {}};
    ExrPart& header = out.part.header;
    header.channels.clear();
    header.multi_view.clear();
    for (size_t i : image.own()) {
      if (channels[i].part != p || channels[i].layer == "invented") continue;  // recomputed
      header.channels.push_back({channels[i].name(), channels[i].type});
      out.planes.push_back(i);
    }
    if (header.channels.empty()) continue;
    header.name = replaced(header.name, view, other_view(view));
    header.view = header.view.empty() ? "" : other_view(view);
    if (p == colors) {
      header.data = job.window;  // invented pixels may be anywhere
      header.channels.push_back({"invented.mask", ChannelType::kHalf});
      header.channels.push_back({"invented.hole", ChannelType::kHalf});
      out.planes.push_back(channels.size());
      out.planes.push_back(channels.size() + 1);
    } else {
      header.data.x0 = std::min(header.data.x0, job.window.x0);
      header.data.x1 = std::max(header.data.x1, job.window.x1);
    }
    move_camera(header, camera);
    std::erase_if(header.attributes, [](const auto& a) {
      return a.first != "worldToCamera" && a.first != "worldToNDC";  // the source's stay
    });
    header.attributes["pelage:stereo"] =
        camera.focal_pixels > 0 ? fmt::format("focal length {} pixels, eye separation {}, convergence {}",
                                              camera.focal_pixels, camera.eye_separation, camera.convergence)
                                : "parallax from a layer";
    job.parts.push_back(std::move(out));
  }
}

std::unique_ptr<FlowField> make_disparity_field(const ViewImage& image, const StereoFileParams& params,
                                                const StereoCamera& camera, const Workers& workers,
                                                PostReport& report) {
  check_field_memory(image, 0, params.file.memory);
  const LayerFinder& layers = image.layers();
  if (!layers.depth()) {
    fail_missing(image, layer_label("depth", params.file.layers.depth), "name a layer with --depth-layer");
  }
  std::vector<uint8_t> edges;
  std::vector<float> depth = image.read_depth(layers.depth(), layers.alpha(), edges);
  std::vector<Flow> vectors;
  if (params.parallax.empty()) {
    join_soft_edges(image.canvas().width(), image.canvas().height(), edges, depth, vectors);
    vectors = parallax_field(depth, camera);
  } else {
    const auto uv = layers.vectors(params.parallax);
    if (!uv) fail_missing(image, "layer " + quote(params.parallax), "give another --parallax-layer");
    vectors = read_layer_vectors(image, *uv, params.file.vectors, "--parallax", "", report);
    join_soft_edges(image.canvas().width(), image.canvas().height(), edges, depth, vectors);
  }
  return std::make_unique<FlowField>(image.canvas().width(), image.canvas().height(), std::move(vectors),
                                     std::move(depth), LinkLimits(), workers, &edges);
}

}  // namespace

std::optional<float> focal_pixels_of(const ExrPart& part) {
  const auto p = projection(part);
  if (!p) return {};
  // A point moved by 1 perpendicular to the axis at depth 1 moves by this fraction of the width.
  const double focal = std::abs((*p)[0][0] / (*p)[2][3]) * part.display.width();
  if (!std::isfinite(focal) || focal <= 0) return {};
  return static_cast<float>(focal);
}

void move_camera(ExrPart& part, const StereoCamera& camera) {
  const auto p = projection(part);
  if (!p || camera.focal_pixels <= 0) return;
  Imath::M44d step;
  step.setTranslation(Imath::V3d(-camera.eye_separation, 0, 0));
  const Imath::M44d to_camera = Imath::M44d(*matrix(part, "worldToCamera")) * step;
  // The picture is shifted so that points at the convergence distance do not move.
  Imath::M44d shifted = *p;
  const double shift = static_cast<double>(camera.focal_pixels) * camera.eye_separation / camera.convergence /
                       part.display.width();
  for (int row = 0; row < 4; ++row) shifted[row][0] += shift * shifted[row][3];
  part.attributes["worldToCamera"] = M44f(to_camera);
  part.attributes["worldToNDC"] = M44f(to_camera * shifted);
}

PostReport stereo_file(const std::filesystem::path& input, const std::filesystem::path& output,
                       const StereoFileParams& params, const Job& job) {
  PostReport report;
  PostSource source(input, job.workers.thread_count());
  ExrReader& reader = source.reader;
  const std::vector<NamedChannel>& channels = source.channels;
  const std::string view = pick_view(reader, views_of(channels, reader.parts()), params);

  BandJob bands(source, params.file, kFillEverything);
  bands.extra_planes = 2;
  MovingView moving;
  moving.image = std::make_unique<ViewImage>(reader, channels, view, params.file.layers);
  const ViewImage& image = *moving.image;
  const StereoCamera camera = params.parallax.empty() ? pick_camera(image, params) : StereoCamera();
  moving.field = make_disparity_field(image, params, camera, job.workers, report);
  const FlowField& field = *moving.field;
  report.longest = std::max(std::abs(field.low().x), std::abs(field.high().x));

  const Overhang by = overhang(field, {0, 1});
  bands.window = image.canvas();
  const int max = image.largest_reach();
  bands.window.x0 = std::max(bands.window.x0 - std::min(by.left, max), image.limits().x0);
  bands.window.x1 = std::min(bands.window.x1 + std::min(by.right, max), image.limits().x1);
  const int width_px = image.limits().x1 - image.limits().x0;
  if (params.parallax.empty() && report.longest > static_cast<float>(width_px)) {
    report.warnings.push_back(
        fmt::format("the parallax reaches {:.0f} pixels, more than the picture's width of {}; check "
                    "--eye-separation and --convergence",
                    static_cast<double>(report.longest), width_px));
  }
  plan_parts(bands, image, view, camera);
  bands.views.push_back(std::move(moving));
  check_named_layers(bands.views, params.file.layers);

  const int margin = stereo_margin(params.filter), height = bands.window.height();
  const int strip_rows = std::max(1, params.strip_rows);
  const bool is_box = params.filter == StereoFilter::kBox;
  const auto width = static_cast<size_t>(bands.window.width());
  const size_t counts = 8 + 64 + (is_box ? 4 * channels.size() : 0);  // per pixel of the strip
  bands.scratch_bytes =
      static_cast<int64_t>(
          WorkBuffer::bytes_needed({0, 0, bands.window.width(), strip_rows + 2 * margin}, bands.scale) +
          width * static_cast<size_t>(strip_rows) * counts +
          (is_box ? 0
                  : LanczosResolve::bytes_needed(bands.window.width(), image.own().size(), bands.scale))) *
      job.workers.thread_count();
  bands.reach = [&](const MovingView& v, const WarpTarget& target, BandJob::Band band) {
    return rows_reaching(*v.field, target, bands.window.width(), std::max(0, band.first - margin),
                         std::min(height, band.last + margin), {1.0f});
  };
  bands.process = [&](const MovingView& v, const WarpTarget& target, BandJob::Band band,
                      const PostLayers& layers) {
    StereoJob stereo;
    stereo.field = v.field.get();
    stereo.target = target;
    stereo.filter = params.filter;
    // Outside of a data window but inside the frame, the picture is known to be empty.
    const PixelBox& canvas = v.image->canvas();
    const PixelBox& display = camera_part(*v.image).display;
    stereo.ends = {canvas.x0 <= display.x0, canvas.x1 >= display.x1};
    stereo.longest_fill = bands.longest_fill;
    stereo.width = bands.window.width();
    stereo.height = height;
    stereo.first_row = band.first;
    stereo.last_row = band.last;
    stereo.invented = bands.extra_plane(0);
    stereo.missing = bands.extra_plane(1);
    stereo_rows(stereo, layers, strip_rows, job.workers, job.progress);
  };
  job.progress.begin("second eye", height);
  bands.run(output, job, report);
  job.progress.end();
  return report;
}

}  // namespace pelage
