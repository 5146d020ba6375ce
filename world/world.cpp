// SPDX-License-Identifier: Apache-2.0
// Tested in tests/world/accelerators_test.cpp.
#include "world/world.h"

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "base/process_usage.h"
#include "image/exr.h"
#include "render/frame/frame_layers.h"
#include "render/render_frame.h"

namespace pelage {

FrameResult render(const World& world, const Job& job) { return render_frame(world.scene, job); }

void write_frame(const std::filesystem::path& path, const World& world, const FrameResult& result,
                 double seconds, const Job& job) {
  FrameHeader header = world.header;
  header.samples = result.samples;
  header.mean_samples = result.mean_samples;
  header.time_limited = result.time_limited;
  header.partial = result.partial;
  header.render_seconds = seconds;
  header.peak_memory_bytes = peak_rss_bytes();
  const Film& film = result.film;
  write_exr(
      path, film.width(), film.height(), exr_attributes(header, world.scene.camera),
      [&film](int y0, int y1) { return film.exr_rows(y0, y1); }, job.workers, job.ledger);
}

MemoryCharge reserve_film(const SceneDescription& scene, const Job& job) {
  job.ledger.set_limit(scene.render.memory.bytes);
  std::vector<FilmLayers::LightInfo> lights;
  for (const auto& [name, position, light] : scene.lights.items)
    lights.push_back({name, std::visit([](const auto& params) { return params.visible; }, light)});
  std::vector<MaterialParams> materials;
  for (const auto& material : scene.materials.items) materials.push_back(material.value);
  const FilmLayers layers = frame_layers(scene.image, scene.render, lights, materials);
  return reserve(job.ledger, MemoryTag::kFilm,
                 Film::bytes_needed(scene.image.width, scene.image.height, layers),
                 fmt::format("the frame buffer alone ({} x {} pixels, before any fur)", scene.image.width,
                             scene.image.height));
}

}  // namespace pelage
