// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vector.h"
#include "render/film/film.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_statistics.h"
#include "render/light/light_set.h"
#include "why/seen_surface.h"
#include "why/strand_why.h"
#include "world/scene_schema.h"
#include "world/world.h"

namespace pelage {

/// The chunk of fur in which a strand is stored.
struct ChunkWhy {
  uint32_t index = 0;              ///< among all chunks of the frame
  size_t strands = 0;              ///< strands of the chunk
  size_t bytes = 0;                ///< memory of the chunk
  Box3f box;                       ///< contains the chunk while the shutter is open; world space
  size_t segment_cell_bounds = 0;  ///< count of boxes of cells of segments; 0 if it has none
  uint32_t growths = 0;  ///< how often it grew for this frame; 0 if it was kept from an earlier frame
};

/// A part of the light of a pixel.
struct LightTerm {
  std::string light;  ///< name of the light source
  std::string lobe;   ///< "diffuse" ..., of the first visible surface; "emission" for a light that is seen
  std::string event;  ///< "direct" or "indirect"; empty for emission
  Rgb radiance{0};
};

/// The material of a visible surface.
struct MaterialWhy {
  std::string name;
  std::string model;
  std::vector<ParameterText> parameters;  ///< of the scene file
  Rgb color{0};                           ///< at the hit, tint of the character included
  float opacity = 1;                      ///< at the hit
};

/// A skin that a pixel shows.
struct SkinWhy {
  std::string name;  ///< "rat.rat"
  uint32_t face = 0;
  V2f place{0};  ///< parameters in the face
  V2f uv{0};     ///< texture coordinates
  V3f rest{0};   ///< rest position, where ramps and noise along x, y and z are evaluated
};

/// Work that the samples of a pixel took.
struct CostWhy {
  RayStatistics rays;
  double trace_s = 0;   ///< CPU seconds of tracing and shading
  double growth_s = 0;  ///< CPU seconds of growing chunks
  int64_t strands_grown = 0;
};

/// Why a pixel is what it is.
struct PixelWhy {
  int x = 0, y = 0;
  uint32_t samples = 0;
  Rgb radiance{0};
  float alpha = 0;
  /// Standard error of the luminance of the pixel's own samples; empty with `gather`, whose samples share
  /// light.
  std::optional<double> noise;
  float depth = 0;                ///< of the visible surface; infinite if there is none
  std::vector<LightTerm> lights;  ///< they add up to `radiance`
  std::vector<SeenCount> seen;    ///< what the camera samples see
  std::optional<StrandWhy> strand;
  std::optional<ChunkWhy> chunk;  ///< of the strand
  std::optional<SkinWhy> skin;    ///< neither a strand nor a skin: the camera sees only lights, or nothing
  std::optional<MaterialWhy> material;
  CostWhy cost;
  bool is_adaptive = false;  ///< whether the picture chooses the sample count of the pixel; here it has all
};

/// A frame that is explained.
struct ExplainedFrame {
  const SceneDescription& scene;
  Assets& assets;
  const World& world;                          ///< composed from `scene` and `assets`
  std::unique_ptr<FrameGeometry>& geometry;    ///< of the world; made if null
  KeptFur* kept = nullptr;                     ///< see render_frame()
  std::optional<FrameSettings> settings = {};  ///< of the picture; empty: those of the world
};

/// Throws Error (kArguments) if a pixel is outside the picture.
void check_pixel(const ImageParams& image, int x, int y);

/// Renders a pixel again with `render.samples` samples and explains it. Its radiance is that of a render of
/// the whole picture, except with adaptive sampling and time limits, which are ignored. Throws Error:
/// kArguments if the pixel is outside the picture, kStopped when the job is stopped, and the errors of
/// render().
PixelWhy explain_pixel(const ExplainedFrame& frame, int x, int y, const Job& job);

}  // namespace pelage
