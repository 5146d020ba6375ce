// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "starter/body_shape.h"
#include "starter/coat_look.h"

namespace pelage {

/// What a first scene for a mesh consists of.
struct StarterScene {
  std::string mesh;  ///< path of the mesh as the scene names it, relative to the folder of the scene
  BodyShape shape;
  CoatLook look;
  int strands = 0;  ///< 0: as many as the look has
};

/// Returns the text of a short scene with comments: a coat, materials, lights and a camera that frames the
/// body. All lengths, positions and sizes follow from the shape, so that a mesh of any size and axes gives
/// the same picture. With more strands, each is thinner.
std::string starter_scene_text(const StarterScene& starter);

}  // namespace pelage
