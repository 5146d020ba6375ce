// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "base/ledger.h"
#include "image/texture.h"
#include "render/light/environment_map.h"
#include "render/light/light.h"

namespace pelage {

/// Light from infinitely far away in every direction: a lat-long image, looked up without interpolation (for
/// crisp sun shadows; see EnvironmentMap), or a constant radiance.
class EnvironmentLight final : public Light {
 public:
  EnvironmentLight(std::string name, const Rgb& radiance, bool visible);
  /// `to_world`: rotation from the space of EnvironmentMap. Throws Error (kInput) for unusable images, Error
  /// (kMemory) when the distribution does not fit the ledger's limit. `check_stop` is called often and may
  /// throw.
  EnvironmentLight(std::string name, std::shared_ptr<const Texture> texture, const Rgb& factor,
                   const M33f& to_world, bool visible, MemoryLedger& ledger,
                   const std::function<void()>& check_stop = {});

  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  float importance(const V3f& from) const override;
  std::optional<V3f> middle(const V3f&) const override { return std::nullopt; }

 private:
  V3f to_map(const V3f& world) const;

  Rgb radiance_;                               ///< of the constant environment
  M33f to_world_;                              ///< for row vectors, as all Imath matrices
  MemoryCharge charge_;                        ///< of the map
  std::unique_ptr<const EnvironmentMap> map_;  ///< null when constant
  float importance_;
};

/// Rotation about x, then y, then z, by degrees, for row vectors.
M33f rotation_xyz(const V3f& degrees);

}  // namespace pelage
