// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "base/ledger.h"
#include "image/texture.h"
#include "render/light/environment_map.h"
#include "render/light/light.h"

namespace pelage {

/// Light that arrives from infinitely far away in every direction. Its radiance is constant, or comes from a
/// lat-long image, which is looked up without interpolation so that the sun casts crisp shadows (see
/// EnvironmentMap). Only the camera sees it interpolated.
class EnvironmentLight final : public Light {
 public:
  /// Makes a light of constant radiance.
  EnvironmentLight(std::string name, const Rgb& radiance, bool visible);
  /// Makes a light from an image. Its radiance is the image times `factor`. `to_world`: rotation from the
  /// space of EnvironmentMap to world space. `check_stop` is called often and may throw. Throws Error
  /// (kInput) for unusable images, and Error (kMemory) when the sampling tables do not fit the ledger's
  /// limit.
  EnvironmentLight(std::string name, std::shared_ptr<const Texture> texture, const Rgb& factor,
                   const M33f& to_world, bool visible, MemoryLedger& ledger,
                   const std::function<void()>& check_stop = {});

  bool is_infinitely_far() const override { return true; }
  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  float pdf_of_hit(const V3f& from, const V3f& direction, const LightHit& hit) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> seen(const V3f& from, const V3f& direction, float time) const override;
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override { return std::nullopt; }

 private:
  V3f to_map(const V3f& world) const;

  Rgb radiance_;         ///< of a constant environment; otherwise, the factor of the image
  M33f to_world_;        ///< for row vectors, like all Imath matrices
  MemoryCharge charge_;  ///< for the memory of map_
  std::unique_ptr<const EnvironmentMap> map_;  ///< null for a constant environment
  float importance_;                           ///< integral of luminance over the sphere
};

/// Returns the matrix that rotates row vectors about x, then y, then z. Angles in degrees.
M33f rotation_xyz(const V3f& degrees);

}  // namespace pelage
