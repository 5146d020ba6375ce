// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "groom/sim/motion_store.h"
#include "world/frame_characters.h"

namespace pelage {

/// A coat with `dynamics` on a character.
struct MovingCoat {
  std::string name;  ///< "rat.under"
  FrameCharacter character;
  size_t part = 0;
  std::shared_ptr<const Groom> groom;
  const DynamicsParams* params = nullptr;
  /// Characters and their parts that guides must not pass (`collide_with`).
  std::vector<std::pair<FrameCharacter, size_t>> colliders;
  int start = 0;  ///< frame at which the simulation begins, as groomed
  /// Name and value of everything that determines the motion.
  std::vector<std::pair<std::string, std::string>> inputs;
  MotionStore store;

  int steps_per_half() const { return (params->substeps + 1) / 2; }
  /// Number of segments of all guides.
  size_t segments() const;
};

/// Returns a coat if it has `dynamics`. moving_coats(): all such coats, without those of crowds, in the order
/// of the scene. A coat that is not simulated has no inputs and no stored motion. `scene` must outlive the
/// result. Throws Error (kInput) for missing poses.
std::vector<MovingCoat> moving_coats(const SceneDescription& scene, const Assets& assets);
std::optional<MovingCoat> moving_coat(const SceneDescription& scene, const Assets& assets,
                                      const FrameCharacter& character, size_t part, const std::string& groom);

/// Returns whether `pelage simulate` has something to do for a scene.
bool has_simulated_coat(const SceneDescription& scene);

/// An input of a motion that had another value when the coat was simulated last.
struct MotionChange {
  std::string name, before;
};

/// store_inputs() stores the inputs of a motion beside it; changed_inputs() compares them with the stored
/// ones, and returns nothing if none are stored. They only inform the user. manifest_file(): where they are.
void store_inputs(const MovingCoat& coat);
std::vector<MotionChange> changed_inputs(const MovingCoat& coat);
std::filesystem::path manifest_file(const MovingCoat& coat);

/// Returns the first and the last frame whose stored motion a picture of a frame needs.
std::pair<int, int> frames_of_motion(const CameraParams& camera, double frame);

/// Returns how the guides of a coat are turned at a frame. Throws like moved_coat().
GuideTurns guide_turns(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat,
                       double frame, const Job& job);

/// Returns a coat as it moves in a frame, or the coat itself if it has no `dynamics`. `keys`: number of
/// motion keys of its skin. Throws Error (kInput) if the motion is missing, with the command to run if the
/// coat is simulated.
std::shared_ptr<const Groom> moved_coat(const SceneDescription& scene, const Assets& assets,
                                        const FrameCharacter& character, size_t part,
                                        const std::string& groom, double frame, size_t keys, const Job& job);

}  // namespace pelage
