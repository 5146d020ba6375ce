// SPDX-License-Identifier: Apache-2.0
#include "cli/grow_boxes.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "procedurals/bounds/bounding.h"
#include "render/frame/frame_chunks.h"
#include "world/compose.h"

namespace pelage {

bool grow_boxes(const SceneDescription& scene, Assets& assets, Run& run) {
  const BoundingOptions bounding{.strategy = scene.render.bounds};
  if (!measures_strands(bounding.strategy)) return true;
  for (const int frame : scene.frames.frames) {
    const double began = run.seconds();
    const World world = run.stage("pose", [&] { return compose(scene, assets, frame, run.job()); });
    const FrameChunks chunks(world.scene, run.job());
    std::vector<const Procedural*> remembering;
    for (const Procedural* leaf : chunks.leaves()) {
      if (leaf->bounds_record()) remembering.push_back(leaf);
    }
    if (remembering.empty()) continue;
    const bool reduced = std::any_of(world.scene.fur.begin(), world.scene.fur.end(),
                                     [](const FurPart& part) { return part.lod.has_value(); });
    BoundingCounts counts;
    bound_chunks(bounding, remembering, run.job(), &counts);
    if (run.display().cancelled()) return false;
    const double seconds = run.seconds() - began;
    run.statistics().stages_s["bound"] += seconds;
    std::cout << fmt::format("frame {}: boxes of {} chunks{}, {} read from the cache, {:.2f} s\n", frame,
                             remembering.size(), reduced ? " at reduced detail" : "", counts.remembered,
                             seconds);
  }
  return true;
}

}  // namespace pelage
