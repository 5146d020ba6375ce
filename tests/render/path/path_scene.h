// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "image/texture_library.h"
#include "render/fibre/fibre_material.h"
#include "render/light/light_params.h"
#include "render/light/magnet_params.h"
#include "render/render_frame.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"
#include "tests/procedurals/fixed.h"

namespace pelage {

/// A small scene put together by hand, and its render.
class PathScene {
 public:
  PathScene(int width, int height) {
    image.width = width;
    image.height = height;
    image.filter = PixelFilter::kBox;
    render.integrator = Integrator::kPath;
    render.samples = 64;
    camera.position = V3f(0, 0, 10);
  }

  /// Matches the colour of the material once, instead of before every render.
  size_t add_material(MaterialParams material) {
    const Workers workers(2);
    NoProgress progress;
    materials.push_back(with_tables(std::move(material), {workers, ledger, progress}));
    return materials.size() - 1;
  }
  void add_fur(Strands strands, MaterialParams material) {
    FurPart part;
    part.name = "test.fur" + std::to_string(fur.size());
    part.procedurals.push_back(std::make_unique<FixedStrands>(std::move(strands)));
    part.material = add_material(std::move(material));
    fur.push_back(std::move(part));
  }
  void add_skin(SkinMesh mesh, MaterialParams material) {
    SkinPart part;
    part.name = "test.skin" + std::to_string(skins.size());
    part.skin = std::make_shared<FixedSkin>(std::move(mesh));
    part.material = add_material(std::move(material));
    skins.push_back(std::move(part));
  }
  void add_light(const std::string& name, LightParams params) {
    lights.emplace_back(name, std::move(params));
  }
  void add_sky(const Rgb& radiance) {
    EnvironmentLightParams sky;
    sky.radiance = radiance;
    add_light("sky", sky);
  }

  FrameResult run(const PathOptions& options = {}, int threads = 2) {
    NoProgress progress;
    return run(options, threads, progress);
  }
  FrameResult run(const PathOptions& options, int threads, Progress& progress) {
    return run_frame({options}, threads, progress);
  }
  /// The fur is used up: a scene with fur renders once per call by growing the same strands again.
  FrameResult run_frame(const FrameOptions& options, int threads, Progress& progress) {
    const Workers workers(threads);
    TextureLibrary textures(ledger);
    std::vector<std::unique_ptr<Light>> made;
    for (const auto& [name, params] : lights) made.push_back(make_light(name, params, 1, textures, ledger));
    RenderScene scene{std::move(fur),
                      skins,
                      materials,
                      LightSet(std::move(made)),
                      Camera(camera, 1, image.width, image.height),
                      image,
                      render};
    if (link) link(scene.lights);
    std::vector<MagnetSet::Magnet> attracting;
    for (const auto& [name, params] : magnets) attracting.push_back(make_magnet(name, params, 1));
    scene.magnets = MagnetSet(std::move(attracting));
    FrameResult result = render_frame(scene, {workers, ledger, progress}, options);
    statistics += result.statistics;
    fur = std::move(scene.fur);
    return result;
  }

  CameraParams camera;
  ImageParams image;
  RenderParams render;
  std::vector<FurPart> fur;
  std::vector<SkinPart> skins;
  std::vector<MaterialParams> materials;
  std::vector<std::pair<std::string, LightParams>> lights;
  std::vector<std::pair<std::string, MagnetParams>> magnets;
  std::function<void(LightSet&)> link;  ///< calls Light::link(); may be empty
  MemoryLedger ledger;
  FrameStatistics statistics;  ///< of all runs
};

/// One strand through the given points.
inline Strands one_strand(const std::vector<V3f>& points, float radius) {
  StrandArrays a;
  for (const V3f& p : points) a.points.insert(a.points.end(), {p.x, p.y, p.z, radius});
  a.first_point = {0, static_cast<uint32_t>(points.size())};
  a.ids = {7};
  return Strands(std::move(a));
}

/// Straight hair all over a unit sphere about the origin, leaning every way.
inline Strands furball(uint32_t strands, float length, float radius) {
  StrandArrays a;
  a.first_point = {0};
  for (uint32_t i = 0; i < strands; ++i) {
    SampleStream stream(17, i, 0, 0);
    const V3f root = uniform_direction(stream.next2d());
    const V3f along = (root + 0.5f * uniform_direction(stream.next2d())).normalized();
    for (float v : {0.0f, 0.5f, 1.0f}) {
      const V3f p = root + v * length * along;
      a.points.insert(a.points.end(), {p.x, p.y, p.z, radius});
    }
    a.first_point.push_back(3 * (i + 1));
    a.ids.push_back(i);
  }
  return Strands(std::move(a));
}

/// A fibre that only scatters diffusely.
inline ConeShellParams diffuse_fibre(const Rgb& albedo) {
  ConeShellParams params;
  params.color = Field(albedo);
  params.diffuse = 1;
  params.primary = Rgb(0);
  params.secondary = Rgb(0);
  return params;
}

/// A sphere about the origin with smooth normals.
inline SkinMesh sphere_mesh(float radius, uint32_t rows = 24) {
  const uint32_t columns = 2 * rows;
  constexpr float kTurn = 6.28318531f;
  SkinMesh mesh;
  for (uint32_t i = 0; i <= rows; ++i) {
    for (uint32_t j = 0; j < columns; ++j) {
      const float theta = 0.5f * kTurn * static_cast<float>(i) / static_cast<float>(rows);
      const float phi = kTurn * static_cast<float>(j) / static_cast<float>(columns);
      const V3f n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
      mesh.positions.insert(mesh.positions.end(), {radius * n.x, radius * n.y, radius * n.z});
    }
  }
  for (uint32_t i = 0; i < rows; ++i) {
    for (uint32_t j = 0; j < columns; ++j) {
      const uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
      if (i > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b, b + columns});
      if (i + 1 < rows) mesh.triangles.insert(mesh.triangles.end(), {a, b + columns, a + columns});
    }
  }
  mesh.faces.assign(mesh.triangle_count(), 0);
  mesh.vertex_uv.assign(mesh.triangles.size(), V2f(0));
  return mesh;
}

/// Mean of the radiance over all pixels, and of its luminance's square.
struct PictureMean {
  Rgb mean{0};
  double standard_error = 0;  ///< of the mean luminance, pixels taken as independent
};

/// Pixels of equal expectation (or blocks of them) as samples of one number.
inline PictureMean picture_mean(const Film& film) {
  PictureMean result;
  double sum = 0, squares = 0;
  const int count = film.width() * film.height();
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const Rgb c = film.radiance(x, y);
      result.mean += c / static_cast<float>(count);
      sum += luminance(c);
      squares += static_cast<double>(luminance(c)) * luminance(c);
    }
  }
  const double mean = sum / count;
  result.standard_error = std::sqrt(std::max(0.0, squares / count - mean * mean) / count);
  return result;
}

}  // namespace pelage
