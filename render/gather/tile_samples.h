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

namespace pelage {

/// The start of a ray that leaves a visible point.
struct LeavingRay {
  V3f origin{0};
  V3f direction{0};
  float far = 0;
};

/// A point of a strand or skin that a camera sample sees, with a ray drawn from its lobes.
struct VisiblePoint {
  uint32_t pixel = 0;   ///< within the tile
  uint32_t sample = 0;  ///< number of the sample in its pixel
  uint32_t knot = 0;    ///< index in TileSamples::zone_of_knot
  float time = 0;
  uint32_t random = 0;     ///< PathState::random
  StrandStart start = {};  ///< Hit::start; empty if a ray may hit the strand that it leaves

  LeavingRay scattered;  ///< a direction drawn from the lobes
  /// rho / pdf of that direction, by lobe group; all 0: none was drawn
  Rgb weights[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};

  Ray ray(const LeavingRay& leaving) const {
    Ray result;
    result.origin = leaving.origin;
    result.direction = leaving.direction;
    result.far = leaving.far;
    result.time = time;
    result.start = start;
    return result;
  }
  Rgb weight() const { return weights[0] + weights[1] + weights[2]; }
};

/// A shadow ray that may be traced from a visible point to one light. Its target is chosen among several
/// points on the light, in proportion to the luminance that each point scatters to the camera.
struct LightRay {
  uint32_t point = 0, light = 0;  ///< indices
  float unoccluded = 0;  ///< luminance that all of the light scatters to the camera if nothing blocks it
  /// Estimate of the light that all of the light source scatters to the camera if nothing blocks it, by lobe
  /// group, from the chosen light point alone. Its luminance is `unoccluded`.
  Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  LeavingRay ray;
};

/// The camera samples of a tile, with the points and lights that they see. One thread fills it.
struct TileSamples {
  static constexpr uint32_t kNoPoint = ~0u;

  struct Sample {
    V2f offset{0};              ///< in its pixel
    uint32_t pixel = 0;         ///< within the tile
    uint32_t point = kNoPoint;  ///< the visible point; kNoPoint: none
  };
  /// Light that a sample sees directly.
  struct SeenLight {
    uint32_t sample = 0, light = 0;  ///< indices
    Rgb radiance{0};
  };
  struct Front {
    FrontSurface of_pixel;
    uint32_t sample = 0;  ///< index of the sample that saw it
  };

  Tile tile;
  uint64_t random_key = 0;      ///< key of the tile's random numbers
  std::vector<Sample> samples;  ///< in the order in which they were traced
  std::vector<SeenLight> seen_lights;
  std::vector<Front> fronts;  ///< by pixel
  std::vector<VisiblePoint> points;
  std::vector<LightRay> light_rays;  ///< point by point, at most one per light
  /// Light that reaches the camera if nothing blocks it, by point, light and lobe group.
  std::vector<Rgb> unoccluded;
  std::vector<uint32_t> zone_of_knot;  ///< see KnotKey::zone
  uint32_t zones = 0;                  ///< number of zones

  /// Clears everything and reserves the memory of the samples.
  void begin(const Tile& of, uint32_t samples_per_pixel, size_t lights);
  size_t pixels() const { return static_cast<size_t>(columns()) * static_cast<size_t>(tile.y1 - tile.y0); }
  int x(uint32_t pixel) const { return tile.x0 + static_cast<int>(pixel) % columns(); }
  int y(uint32_t pixel) const { return tile.y0 + static_cast<int>(pixel) / columns(); }
  uint32_t zone(const VisiblePoint& point) const { return zone_of_knot[point.knot]; }

  /// Max memory of one sample.
  static size_t bytes_per_sample(size_t lights);

 private:
  int columns() const { return tile.x1 - tile.x0; }
};

}  // namespace pelage
