// SPDX-License-Identifier: Apache-2.0
#include "why/pixel_why.h"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "render/accel/flush_denormals.h"
#include "render/frame/frame_shading.h"
#include "render/frame/skin_point.h"
#include "render/frame/strand_fields.h"
#include "world/kept_render.h"

namespace pelage {
namespace {

/// Explains a chunk of fur. Grows it if it is not in memory.
ChunkWhy explain_chunk(const FrameGeometry& geometry, uint32_t chunk) {
  const FlushDenormals flush;
  const ResidentChunks& chunks = geometry.chunks();
  ChunkWhy why;
  why.index = chunk;
  chunks.visit(chunk, 0, [&](const ChunkGeometry& content) {
    why.strands = content.strand_count();
    why.bytes = content.bytes();
    return 0;
  });
  why.box = chunks.boxes().whole(chunk);
  why.segment_cell_bounds = chunks.boxes().cell_bounds(chunk).count();
  why.growths = geometry.growths(chunk);
  return why;
}

/// Returns the light of pixel (x, y) of a film by light source, lobe and event, the brightest first. The
/// terms add up to the pixel. The film must have event layers.
std::vector<LightTerm> light_terms(const Film& film, const LightSet& lights, int x, int y) {
  const FilmLayers& layers = film.layers();
  PELAGE_CHECK(layers.events && layers.lights() == lights.size());
  std::vector<LightTerm> terms;
  for (size_t light = 0; light < lights.size(); ++light) {
    const std::string name = lights.light(light).name();
    for (int group = 0; group < layers.groups; ++group) {
      const size_t all = layers.scattered(light, group);
      const std::string lobe = layers.names[all].substr(name.size() + 1);
      const Rgb direct = film.layer(x, y, layers.direct(light, group));
      terms.push_back({name, lobe, "direct", direct});
      terms.push_back({name, lobe, "indirect", film.layer(x, y, all) - direct});
    }
    if (lights.light(light).visible())
      terms.push_back({name, "emission", "", film.layer(x, y, layers.emitted(light))});
  }
  std::stable_sort(terms.begin(), terms.end(), [](const LightTerm& a, const LightTerm& b) {
    return luminance(a.radiance) > luminance(b.radiance);
  });
  return terms;
}

float opacity_at(const RenderScene& frame, const SeenSurface& surface) {
  const FurPart& part = frame.fur[surface.hit.part];
  const Strands& strand = surface.hit_geometry.strand;
  const FibreParams& fibre = *fibre_params(frame.materials[part.material]);
  std::vector<float> opacities = point_opacities(fibre.opacity, strand, part);
  if (opacities.empty()) return 1;
  const StrandAttribute opacity{"opacity", AttributeClass::kPerPoint, 1, std::move(opacities)};
  float value = 1;
  interpolate_attribute(strand, opacity, 0, surface.hit.segment, surface.hit.u, &value);
  return value;
}

/// Explains the material of a surface. `frame`: composed from `scene`.
MaterialWhy explain_material(const SceneDescription& scene, const RenderScene& frame,
                             const SeenSurface& surface) {
  const bool is_strand = surface.hit.kind == HitKind::kStrand;
  const size_t index =
      is_strand ? frame.fur[surface.hit.part].material : frame.skins[surface.hit.part].material;
  const auto& item = scene.materials.items[index];
  MaterialWhy why;
  why.name = item.name;
  std::visit(
      [&]<class P>(const P& params) {
        why.model = P::kTypeName;
        why.parameters = P::schema().describe(params);
      },
      item.value);
  why.color = FrameShading(frame).color(surface.hit, surface.hit_geometry);
  if (is_strand) why.opacity = opacity_at(frame, surface);
  return why;
}

/// Settings with which the film of a frame has all layers, and each pixel all its samples.
FrameSettings with_all_layers(FrameSettings settings) {
  settings.image.light_layers = settings.image.event_layers = true;
  settings.image.noise_layers = settings.render.integrator == Integrator::kPath;
  settings.render.adaptive.reset();
  settings.render.time_limit = 0;
  return settings;
}

SkinWhy explain_skin(const RenderScene& scene, const SeenSurface& surface) {
  const SkinPart& part = scene.skins[surface.hit.part];
  const SkinMesh& triangle = surface.hit_geometry.triangle;
  SkinWhy why{part.name, triangle.faces[0], skin_parameters(triangle, surface.hit), V2f(0), V3f(0)};
  if (part.rest) {
    why.uv = part.rest->topology().texture_coordinates(why.face, why.place.x, why.place.y);
    why.rest = part.rest->evaluate(why.face, why.place.x, why.place.y).position;
  }
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
  options.settings = with_all_layers(frame.settings.value_or(FrameSettings{scene.image, scene.render}));
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
