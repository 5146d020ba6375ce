// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "image/texture_library.h"
#include "render/light/environment_light.h"
#include "render/light/light_params.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "render/sampling/warp.h"

namespace pelage {

namespace {

struct LightMaker {
  const std::string& name;
  double frame;
  TextureLibrary& textures;
  MemoryLedger& ledger;
  const V3f& origin;

  std::unique_ptr<Light> operator()(const RectangleLightParams& p) const {
    Rectangle shape;
    shape.center = relative_to(p.position, origin).at(frame);
    const V3f forward = relative_to(p.look_at, origin).at(frame) - shape.center;
    if (!(forward.length() > 0)) {
      throw Error(ErrorKind::kInput,
                  fmt::format("lights.{}: position and look_at are the same point at frame {}", name, frame));
    }
    const V3f normal = forward.normalized();
    shape.x = p.up.cross(normal);
    if (shape.x.length() > 1e-6f * p.up.length()) {
      shape.x.normalize();
    } else {
      V3f unused;
      complete_frame(normal, shape.x, unused);
    }
    shape.y = normal.cross(shape.x);
    shape.half_size = p.size * 0.5f;
    return std::make_unique<RectangleLight>(name, shape, p.radiance * p.intensity.at(frame), p.two_sided,
                                            p.visible);
  }

  std::unique_ptr<Light> operator()(const SphereLightParams& p) const {
    return std::make_unique<SphereLight>(name, relative_to(p.position, origin).at(frame), p.radius,
                                         p.radiance * p.intensity.at(frame), p.visible);
  }

  std::unique_ptr<Light> operator()(const EnvironmentLightParams& p) const {
    const Rgb factor = p.radiance * p.intensity.at(frame);
    if (p.file.empty()) return std::make_unique<EnvironmentLight>(name, factor, p.visible);
    try {
      return std::make_unique<EnvironmentLight>(name, textures.load(p.file, ColorSpace::kAuto), factor,
                                                rotation_xyz(p.rotate), p.visible, ledger,
                                                [this] { textures.check_stop(); });
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::kStopped) throw;
      std::vector<Problem> problems = error.problems();
      for (Problem& problem : problems) {
        if (problem.position.file.empty()) {
          problem = {p.file.position, fmt::format("{}: {}", p.file.path.string(), problem.message)};
        }
      }
      throw Error(error.kind(), std::move(problems));
    }
  }
};

}  // namespace

std::unique_ptr<Light> make_light(const std::string& name, const LightParams& params, double frame,
                                  TextureLibrary& textures, MemoryLedger& ledger, const V3f& origin) {
  return std::visit(LightMaker{name, frame, textures, ledger, origin}, params);
}

}  // namespace pelage
