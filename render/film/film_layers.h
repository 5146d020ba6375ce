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
  kDrawn,    ///< sample positions come from the pixel's filter; each sample counts for that pixel alone
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
  bool light_layers = true;                     ///< one layer per light and lobe group
  bool event_layers = false;                    ///< direct and indirect part of each, as two more layers
  bool noise_layers = false;
  bool lod_layer = false;
  AssetPath background;  ///< picture behind everything (class PlateLight); empty: visible lights
  static const Schema<ImageParams>& schema();
};

/// The light layers of a film. Each light source has one layer per lobe group. The layer holds the part of
/// this source's radiance that these lobes of the first visible surface scatter to the camera. Skin counts as
/// diffuse, except that a clear coat counts as the primary highlight. A light that the camera may see has one
/// layer more, for the light that the camera sees directly (emission).
///
/// With `events`, the scattered light of each layer is divided further. Direct light came to the first
/// visible surface straight from the light source. Indirect light was scattered at least once before. A film
/// stores the direct part of each layer; the rest of the layer is indirect.
struct FilmLayers {
  struct LightInfo {
    std::string name;
    bool visible = false;  ///< whether the camera sees the light
  };
  /// Returns the layers for these lights. `groups`: count of lobe groups that have layers, from the first of
  /// LobeGroup on. The materials of the scene use no other groups.
  static FilmLayers make(const std::vector<LightInfo>& lights, int groups, bool events = false);

  /// Names of the layers that are stored: "key.diffuse" ...; with `events`, "key.diffuse.direct" ... follow.
  /// Empty when light layers are off.
  std::vector<std::string> names;
  int groups = 0;                    ///< count of lobe groups, see make()
  bool events = false;               ///< image.event_layers
  bool noise = false;                ///< whether the film has the layers `samples` and `noise`
  bool lod = false;                  ///< whether the film has the layer `lod` (VisibleSurface::left_out)
  std::optional<PixelFilter> splat;  ///< the pixel filter with FilterSamples::kSplatted; empty with kDrawn

  bool empty() const { return names.empty(); }
  size_t size() const { return names.size(); }
  size_t lights() const { return first_.size(); }
  // Indices in `names`.
  /// Returns the layer of the light that a lobe group scatters.
  size_t scattered(size_t light, int group) const { return first_[light] + static_cast<size_t>(group); }
  /// Returns the layer of the emission of a light that is visible to the camera.
  size_t emitted(size_t light) const { return first_[light] + static_cast<size_t>(groups); }
  /// Returns the layer of the direct part of scattered(light, group). Only with `events`.
  size_t direct(size_t light, int group) const {
    return first_direct_ + light * static_cast<size_t>(groups) + static_cast<size_t>(group);
  }

 private:
  std::vector<size_t> first_;  // index of each light's first layer
  size_t first_direct_ = 0;
};

}  // namespace pelage
