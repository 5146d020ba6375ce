// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "geom/strands.h"
#include "lod/simplification.h"
#include "why/seen_surface.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// A strand at its root, in its middle and at its tip, when the shutter opens. The middle is where the curve
/// has as many segments before it as after it.
struct StrandPlaces {
  static constexpr std::array<const char*, 3> kNames{"root", "middle", "tip"};

  std::array<V3f, 3> position;
  std::array<float, 3> width;               ///< diameter
  std::optional<std::array<Rgb, 3>> color;  ///< the attribute `color`, if the strand has one
  float length = 0;                         ///< arc length
};

/// Measures strand 0 of a batch. It must have a segment.
StrandPlaces strand_places(const Strands& strand);

/// What one step of a groom does to a strand.
struct StepWhy {
  /// "follicle" (the straight strand before the first operator), the name of an operator, and at the end
  /// "stored": level of detail, and the rounding of caches and of chunks.
  std::string name;
  StrandPlaces after;
};

/// Why level of detail keeps a strand.
struct LodWhy {
  LodMeasures measures;
  float priority = 0;   ///< of the strand; a strand is kept if it is small compared with measures.share
  float fade = 1;       ///< Simplification::fade()
  float width = 1;      ///< factor on the width
  float contrast = 1;   ///< factor on the deviation of its colour from the mean
  float tolerance = 0;  ///< max distance by which a refit with fewer points may move it, scene units
};

/// A strand that a pixel shows.
struct StrandWhy {
  std::string coat;  ///< "rat.under"
  uint64_t id = 0;
  uint32_t segment = 0;
  float along = 0;                  ///< where it is hit: 0 at the root, 1 at the tip
  float across = 0;                 ///< where it is hit: h in [-1, 1]
  std::optional<RootAddress> root;  ///< empty if it grows on no skin
  V2f root_uv{0};                   ///< texture coordinates of the root
  V3f rest{0};  ///< rest position of the root, where ramps and noise along x, y and z are evaluated
  std::vector<StepWhy> steps;
  std::optional<LodWhy> lod;  ///< empty if the level of detail of the coat is not reduced
  /// The centre line in the picture when the camera sample was taken, in pixels, from root to tip. Points
  /// behind the camera are omitted.
  std::vector<V2f> outline;

  const StrandPlaces& places() const { return steps.back().after; }
};

/// Explains the strand that `surface` is. `frame`: composed from `scene` and `assets`. Grows the strand step
/// by step. For a groom with a cache, prepares its operators again. Throws the errors of Groom::create().
StrandWhy explain_strand(const SceneDescription& scene, Assets& assets, const RenderScene& frame,
                         const SeenSurface& surface, const Job& job);

}  // namespace pelage
