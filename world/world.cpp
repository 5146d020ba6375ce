// SPDX-License-Identifier: Apache-2.0
#include "world/world.h"

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "base/process_usage.h"
#include "image/display_image.h"
#include "image/exr.h"
#include "image/view_transform.h"
#include "render/frame/frame_layers.h"
#include "render/render_frame.h"
#include "world/kept_render.h"

namespace pelage {

namespace {

DisplayImage display_image(const FrameResult& result) {
  const auto& [picture, region, traced, stored] = result.window;
  DisplayImage image{region.width(), region.height(), {}};
  image.pixels.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  for (int y = region.y0; y < region.y1; ++y) {
    for (int x = region.x0; x < region.x1; ++x) {
      const Rgb color = result.film.radiance(x - stored.x0, y - stored.y0);
      for (int c = 0; c < 3; ++c) image.pixels.push_back(view_byte(color[c]));
    }
  }
  return image;
}

}  // namespace

FrameResult render(const World& world, const Job& job, const FrameOptions& options) {
  return render_frame(world.scene, job, options);
}

FrameResult render(const World& world, const Job& job, const FrameOptions& options,
                   std::unique_ptr<FrameGeometry>& geometry, KeptFur* kept) {
  return render_frame(world.scene, job, options, geometry, kept);
}

FrameHeader finished_header(const World& world, const FrameResult& result, double seconds) {
  FrameHeader header = world.header;
  header.samples = result.samples;
  header.mean_samples = result.mean_samples;
  header.time_limited = result.time_limited;
  header.partial = result.partial;
  header.render_seconds = seconds;
  header.peak_memory_bytes = peak_rss_bytes();
  return header;
}

void write_frame(const std::filesystem::path& path, const World& world, const FrameResult& result,
                 double seconds, const Job& job) {
  write_frame(path, finished_header(world, result, seconds), world.scene.camera, result, job);
}

void write_frame(const std::filesystem::path& path, const FrameHeader& header, const Camera& camera,
                 const FrameResult& result, const Job& job) {
  if (is_display_image(path)) return write_display_image(path, display_image(result));
  const Film& film = result.film;
  const auto& [picture, region, traced, stored] = result.window;
  const int left = region.x0 - stored.x0, top = region.y0 - stored.y0, right = left + region.width();
  write_exr(
      path, region, picture, exr_attributes(header, camera),
      [&](int y0, int y1) {
        return film.exr_pixels({left, top + y0, right, top + y1});
      },
      job.workers, job.ledger);
}

MemoryCharge reserve_film(const SceneDescription& scene, const Job& job,
                          const std::optional<PixelBox>& region) {
  job.ledger.set_limit(scene.render.memory.bytes);
  std::vector<FilmLayers::LightInfo> lights;
  for (const auto& [name, position, light] : scene.lights.items)
    lights.push_back({name, std::visit([](const auto& params) { return params.visible; }, light)});
  std::vector<MaterialParams> materials;
  for (const auto& material : scene.materials.items) materials.push_back(material.value);
  const FilmLayers layers = frame_layers(scene.image, scene.render, lights, materials);
  const PixelBox film = frame_window(scene.image.width, scene.image.height, region, layers.splat).film;
  return reserve(job.ledger, MemoryTag::kFilm, Film::bytes_needed(film.width(), film.height(), layers),
                 fmt::format("the frame buffer alone ({} x {} pixels, before any fur)", scene.image.width,
                             scene.image.height));
}

}  // namespace pelage
