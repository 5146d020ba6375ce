// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/accel/accel.h"
#include "render/fibre/fibre_value.h"
#include "render/film/visible_surface.h"
#include "render/frame/tile_order.h"
#include "render/gather/zones.h"

namespace pelage {

/// The start of a ray that leaves a visible point.
struct LeavingRay {
  V3f origin{0};
  V3f direction{0};
  float far = 0;                     ///< length
  const PartSet* casters = nullptr;  ///< as Ray::casters
};

/// A point of a strand or skin that a camera sample sees, with one ray in a direction sampled from its lobes.
struct VisiblePoint {
  uint32_t pixel = 0;         ///< index of the pixel in the tile
  uint32_t sample = 0;        ///< index of the sample in its pixel
  uint32_t gather_point = 0;  ///< index in TileSamples::zone_of_gather_point
  DepthPlace depth;
  float time = 0;          ///< of the shutter, in [0, 1]
  uint32_t random = 0;     ///< PathState::random at this point
  StrandStart start = {};  ///< Hit::start; empty if a ray may hit the strand that it leaves

  LeavingRay scattered;  ///< the ray sampled from the lobes
  /// rho / pdf of the direction of `scattered`, by lobe group; all 0 if no ray was sampled
  Rgb weights[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  float attraction = 1;  ///< FibreValue::attraction of this direction

  /// Returns `leaving` as a ray that the accelerator can trace.
  Ray ray(const LeavingRay& leaving) const {
    Ray result;
    result.origin = leaving.origin;
    result.direction = leaving.direction;
    result.far = leaving.far;
    result.casters = leaving.casters;
    result.time = time;
    result.start = start;
    return result;
  }
  /// Returns the sum of `weights` over the lobe groups.
  Rgb weight() const { return weights[0] + weights[1] + weights[2]; }
};

/// A shadow ray from a visible point to a light; ShadowRays decides whether it is traced. Its target is one
/// of several candidate points on the light. The probability of a candidate is proportional to the luminance
/// that its light would bring to the camera if nothing blocked it. If a point has several rays to a light,
/// each represents a part of the light of all candidates.
struct LightRay {
  uint32_t point = 0, light = 0;  ///< indices of the visible point and of the light
  /// Luminance that the point scatters to the camera from the ray's part of the candidates if nothing blocks
  /// the light.
  float unoccluded = 0;
  /// Estimate, by lobe group, of the light whose luminance is `unoccluded`. It uses the colours of the chosen
  /// candidate only.
  Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  LeavingRay ray;
};

/// The camera samples of a tile, with the points and lights that they see. Used by one thread at a time.
struct TileSamples {
  static constexpr uint32_t kNoPoint = ~0u;

  struct Sample {
    V2f offset{0};              ///< from the centre of its pixel, in pixels
    uint32_t pixel = 0;         ///< index of the pixel in the tile
    uint32_t point = kNoPoint;  ///< index in `points`; kNoPoint: the sample hits nothing, or a shadow catcher
    float alpha = 0;
  };
  /// A light that a sample sees directly.
  struct SeenLight {
    uint32_t sample = 0, light = 0;  ///< indices of the sample and of the light
    Rgb radiance{0};
  };
  /// The data of a pixel that cannot be averaged.
  struct Front {
    FrontSurface of_pixel;
    uint32_t sample = 0;  ///< index in `samples` of the sample that sees of_pixel
  };

  Tile tile;
  uint64_t random_key = 0;      ///< key of the random numbers of this trace of the tile
  std::vector<Sample> samples;  ///< in the order in which they were traced
  std::vector<SeenLight> seen_lights;
  std::vector<Front> fronts;  ///< by pixel
  std::vector<VisiblePoint> points;
  std::vector<LightRay> light_rays;  ///< by point, then by light; at most targets() of each
  /// Direct light that the points scatter to the camera if nothing blocks it, by point, light and lobe group.
  std::vector<Rgb> unoccluded;
  std::vector<uint32_t>
      zone_of_gather_point;  ///< index of the zone (see GatherPointKey) of each gather point
  std::vector<uint32_t> patch_of_gather_point;  ///< index of the patch of each gather point
  uint32_t zones = 0, patches = 0;              ///< count of each

  /// Clears everything and reserves the memory of the samples.
  void begin(const Tile& of, uint32_t samples_per_pixel, size_t lights);
  /// Returns the count of pixels of the tile. Their indices run row by row.
  size_t pixels() const { return static_cast<size_t>(columns()) * static_cast<size_t>(tile.y1 - tile.y0); }
  // Position of a pixel in the picture.
  int x(uint32_t pixel) const { return tile.x0 + static_cast<int>(pixel) % columns(); }
  int y(uint32_t pixel) const { return tile.y0 + static_cast<int>(pixel) / columns(); }
  /// Returns the zone of the gather point that the visible point is assigned to.
  uint32_t zone(const VisiblePoint& point) const { return zone_of_gather_point[point.gather_point]; }

  /// Returns the max count of shadow rays from a point to each light of a scene with so many lights. A single
  /// light gets two rays, because otherwise the noise of its visibility exceeds all other noise.
  static constexpr uint32_t targets(size_t lights) { return lights == 1 ? 2 : 1; }
  /// Returns the max memory of one sample, in bytes.
  static size_t bytes_per_sample(size_t lights);

 private:
  int columns() const { return tile.x1 - tile.x0; }
};

}  // namespace pelage
