// SPDX-License-Identifier: Apache-2.0
#include "why/pixel_why.h"

#include <fmt/format.h>

#include "base/error.h"
#include "render/frame/skin_point.h"

namespace pelage {
namespace {

/// Settings with which the film of a frame has all layers, and each pixel all its samples.
FrameSettings with_all_layers(const RenderScene& scene) {
  FrameSettings settings{scene.image, scene.render};
  settings.image.light_layers = settings.image.event_layers = true;
  settings.image.noise_layers = scene.render.integrator == Integrator::kPath;
  settings.render.adaptive.reset();
  settings.render.time_limit = 0;
  return settings;
}

SkinWhy explain_skin(const RenderScene& scene, const SeenSurface& surface) {
  const SkinPart& part = scene.skins[surface.hit.part];
  const SkinMesh& triangle = surface.met.triangle;
  SkinWhy why{part.name, triangle.faces[0], skin_parameters(triangle, surface.hit), V2f(0)};
  if (part.rest) why.uv = part.rest->topology().texture_coordinates(why.face, why.place.x, why.place.y);
  return why;
}

void explain_surface(const ExplainedFrame& frame, const SeenSurface& surface, const Job& job, PixelWhy& why) {
  const RenderScene& scene = frame.world.scene;
  why.material = explain_material(frame.scene, scene, surface);
  if (surface.hit.kind == HitKind::kSkin) {
    why.skin = explain_skin(scene, surface);
    return;
  }
  why.strand = explain_strand(frame.scene, frame.assets, scene, surface, job);
  const StrandHandle stored = surface.hit.handle();
  if (stored) why.chunk = explain_chunk(*frame.geometry, stored.chunk);
}

/// Growth of a geometry so far; zero while there is none.
struct Growth {
  double cpu_s = 0;
  int64_t strands = 0;
  explicit Growth(const FrameGeometry* geometry) {
    if (!geometry) return;
    cpu_s = geometry->growth_cpu_s();
    strands = geometry->strands_grown();
  }
};

}  // namespace

void check_pixel(const ImageParams& image, int x, int y) {
  if (x >= 0 && y >= 0 && x < image.width && y < image.height) return;
  throw Error(ErrorKind::kArguments,
              fmt::format("pixel {} {}: the picture has {} x {} pixels", x, y, image.width, image.height));
}

PixelWhy explain_pixel(const ExplainedFrame& frame, int x, int y, const Job& job) {
  const RenderScene& scene = frame.world.scene;
  check_pixel(scene.image, x, y);
  PixelWhy why;
  why.x = x;
  why.y = y;
  why.is_adaptive = scene.render.adaptive.has_value();
  FrameOptions options;
  options.settings = with_all_layers(scene);
  options.region = PixelBox{x, y, x + 1, y + 1};
  const Growth before(frame.geometry.get());
  const FrameResult result = render(frame.world, job, options, frame.geometry, frame.kept);
  job.check_stop();
  const Film& film = result.film;
  const int column = x - result.window.film.x0, row = y - result.window.film.y0;
  why.samples = film.samples(column, row);
  why.radiance = film.radiance(column, row);
  why.alpha = film.alpha(column, row);
  why.depth = film.surface(column, row).depth;
  if (!film.moments().empty())
    why.noise = film.moments()[static_cast<size_t>(row * film.width() + column)].error();
  why.lights = light_terms(film, scene.lights, column, row);
  const Growth after(frame.geometry.get());
  why.cost = {result.statistics.rays, result.statistics.cpu_s.total(), after.cpu_s - before.cpu_s,
              after.strands - before.strands};
  SeenSurfaces seen =
      find_seen_surfaces(scene, frame.geometry->accel(), film.layers().splat.has_value(), x, y, why.samples);
  why.seen = std::move(seen.counts);
  if (seen.front) explain_surface(frame, *seen.front, job, why);
  return why;
}

}  // namespace pelage
