// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "base/hash.h"

namespace pelage {

class Value;

/// Hashes of the parts of a scene's document. The keys are paths: "camera" for a block, and "image.width",
/// "lights.key" or "render.samples" for the items of a block that is a map. The blocks of materials and
/// the block `render.gather` are divided once more: "materials.fur.color", "render.gather.spacing".
using SceneParts = std::map<std::string, ContentHash>;

/// Returns the parts of a document to which includes and overrides have been applied.
SceneParts scene_parts(const Value& document);

/// What must be done again when a scene changes. Each value includes the work of those before it.
enum class Redo {
  kNothing,   ///< the documents are equal
  kSampling,  ///< the samples of the picture; all geometry stays valid
  kGeometry,  ///< the world and its geometry; the assets stay valid
  kAssets,    ///< everything
};

/// Returns what must be done again for a scene with the parts `after`, if everything was done for `before`.
/// Changes of lights, of materials (except the opacity of fibres, their model, and colours that are
/// attributes of strands) and of keys that concern only sampling need kSampling. Changes of the camera, of
/// `frames` and of the keys of `render.gather` that widen strands need kGeometry.
Redo compare_scenes(const SceneParts& before, const SceneParts& after);

}  // namespace pelage
