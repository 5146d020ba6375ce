// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/film/frame_header.h"
#include "render/scene/render_scene.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Counts for one frame, or for all frames of a run together.
struct WorldCounts {
  int64_t strands_described = 0;    ///< number of strands before level of detail
  int64_t strands_unique = 0;       ///< the same, but equal coats on equal poses are counted once
  int64_t characters = 0;           ///< number of characters with a coat
  int64_t characters_in_frame = 0;  ///< number of characters with a coat whose bound intersects the camera's
                                    ///< view

  WorldCounts& operator+=(const WorldCounts& other) {
    strands_described += other.strands_described;
    strands_unique += other.strands_unique;
    characters += other.characters;
    characters_in_frame += other.characters_in_frame;
    return *this;
  }
};

/// One frame, ready to be rendered.
struct World {
  RenderScene scene;
  WorldCounts counts;
  FrameHeader header;  ///< header of the EXR file; write_frame() adds the results of the render
  std::vector<MemoryCharge> charges;
  CameraParams camera;     ///< focused_camera()
  ContentHash poses = {};  ///< hash of the surfaces of all skins, over the shutter
};

/// Where the coordinates of a world start: RenderScene::origin.
enum class CoordinateOrigin {
  kWorld,      ///< at the origin of the scene file
  kNearCoats,  ///< near the coats if they are far from it, so that floats resolve their strands
};

/// Makes the world of one frame: poses skins and coats, and sets up materials, lights and the camera. Does
/// not grow strands. Throws Error: kInput for missing or damaged poses and images, kMemory when memory does
/// not suffice, kStopped when the job is stopped.
World compose(const SceneDescription& scene, Assets& assets, double frame, const Job& job,
              CoordinateOrigin from = CoordinateOrigin::kNearCoats);

/// Replaces everything in a world that does not concern geometry: lights, materials, sampling and layers of
/// the picture, and the header. `scene`: a scene that differs from the scene of the world by Redo::kSampling
/// at most. Throws the same errors as compose(); the world is then unchanged.
void recompose_sampling(const SceneDescription& scene, Assets& assets, double frame, const Job& job,
                        World& world);

}  // namespace pelage
