// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"
#include "render/fibre/fibre_bsdf.h"
#include "render/film/pixel_filter.h"

namespace pelage {

/// How the pixel filter is applied to the samples of a picture (image.filter_samples).
enum class FilterSamples {
  kDrawn,    ///< sample positions are drawn from the pixel's filter; each sample counts for that pixel alone
  kSplatted  ///< samples are spread evenly; each counts for all pixels around it, weighted by their filters
};
template <>
struct EnumNames<FilterSamples> {
  static constexpr const char* names[] = {"drawn", "splatted"};
};

/// `image:` of a scene.
struct ImageParams {
  int width = 1280;
  int height = 720;
  PixelFilter filter = PixelFilter::kBlackmanHarris;
  std::optional<FilterSamples> filter_samples;  ///< empty: kSplatted with the gather integrator, else kDrawn
  bool light_layers = true;                     ///< one layer per light x lobe group
  bool event_layers = false;                    ///< these again, divided into direct and indirect light
  bool noise_layers = false;
  bool lod_layer = false;
  static const Schema<ImageParams>& schema();
};

/// The light layers of a film. For each light: one per lobe group at the first visible surface (skin counts
/// as diffuse); then, for lights visible to the camera, their direct emission.
///
/// With `events`, light that the first visible surface scatters is also divided into direct light, which
/// arrives there from the light source, and indirect light, which was scattered before. A film stores the
/// direct part of each layer; the rest of the layer is indirect.
struct FilmLayers {
  struct LightInfo {
    std::string name;
    bool visible = false;
  };
  /// `groups`: number of lobe groups that the materials of the scene use, counted from the first.
  static FilmLayers make(const std::vector<LightInfo>& lights, int groups, bool events = false);

  /// Of the layers that are stored: "key.diffuse" ..., then, with `events`, "key.diffuse.direct" ...; empty
  /// when light layers are off.
  std::vector<std::string> names;
  int groups = 0;
  bool events = false;               ///< image.event_layers
  bool noise = false;                ///< whether the film stores the variance of each pixel's samples
  bool lod = false;                  ///< whether the film shows how much detail was omitted
  std::optional<PixelFilter> splat;  ///< filter of FilterSamples::kSplatted; empty: kDrawn

  bool empty() const { return names.empty(); }
  size_t size() const { return names.size(); }
  size_t lights() const { return first_.size(); }
  size_t scattered(size_t light, int group) const { return first_[light] + static_cast<size_t>(group); }
  size_t emitted(size_t light) const { return first_[light] + static_cast<size_t>(groups); }
  /// The direct part of scattered(light, group). Only with `events`.
  size_t direct(size_t light, int group) const {
    return first_direct_ + light * static_cast<size_t>(groups) + static_cast<size_t>(group);
  }

 private:
  std::vector<size_t> first_;  // index of each light's first layer
  size_t first_direct_ = 0;
};

}  // namespace pelage
