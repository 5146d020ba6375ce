// SPDX-License-Identifier: Apache-2.0
#include "world/dynamics_check.h"

#include "base/nearest_name.h"

namespace pelage {
namespace {

bool is_simulated(const SceneDescription& scene, const std::string& groom) {
  const auto* coat = scene.grooms.find(groom);
  return coat && coat->value.dynamics && coat->value.dynamics->mode == DynamicsMode::kSimulated;
}

}  // namespace

void check_dynamics(const SceneDescription& scene, Problems& problems) {
  for (const auto& [name, position, groom] : scene.grooms.items) {
    const std::optional<Problem> problem = check_dynamics(groom);
    if (!problem) continue;
    problems.add(problem->position.file.empty() ? position : problem->position,
                 "groom " + quote(name) + ": " + problem->message);
  }
  for (const auto& [name, position, crowd] : scene.crowds.items) {
    for (const NameReference& of : crowd.of) {
      const auto* animal = scene.characters.find(of.name);
      if (!animal) continue;
      for (const PartParams& part : animal->value.parts) {
        for (const auto& groom : part.grooms.items) {
          if (!is_simulated(scene, groom.name)) continue;
          problems.add(position, "crowd " + quote(name) + ": groom " + quote(groom.name) +
                                     " has `dynamics`; animals of a crowd need `mode: kinematic`");
        }
      }
    }
  }
}

}  // namespace pelage
