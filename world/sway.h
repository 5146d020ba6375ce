// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "groom/sim/dynamics_params.h"
#include "groom/strands/guide_turns.h"
#include "world/frame_characters.h"

namespace pelage {

/// Lag and sway of the guides of a coat with `mode: kinematic`. Each guide is a damped spring that carries
/// its tip, and whose foot follows the skin. The lag of the tip is the sum, over the last half frames, of
/// the changes of the foot's velocity times the free vibration that each of them starts. So it depends on the
/// poses of this time alone, and on no frame before. The foot moves with a triangle of the cage near the
/// root, which need not be subdivided. Arguments of the constructor must outlive the object.
class Sway {
 public:
  Sway(const SceneDescription& scene, const Assets& assets, const FrameCharacter& character, size_t part,
       const Groom& groom, const DynamicsParams& params);
  /// The turns at half a frame number.
  GuideTurns at(int half);

 private:
  struct Foot {
    uint32_t corners[3];
    V3d root, tip;  // in the space of the triangle, relative to the length of its first edge
  };
  /// Positions of the tips if the skin carried them rigidly: x, y and z of each guide.
  using Tips = std::vector<double>;
  Tips find_tips(int half) const;
  const Tips& tips(int half);

  const Assets& assets_;
  const FrameCharacter& character_;
  size_t part_;
  size_t segments_;
  double step_, frequency_, damping_;
  std::vector<Foot> feet_;
  std::map<int, Tips> known_;
};

}  // namespace pelage
