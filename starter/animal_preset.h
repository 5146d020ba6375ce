// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "starter/animal_coat.h"
#include "starter/coat_look.h"

namespace pelage {

/// Returns the keys of a groom that replace `preset: NAME`, as a block of YAML in one line, for a scene
/// with `units_per_mm` scene units per millimetre.
///
/// `part` is the fraction of the measured density that grows, greater than 0. Measured coats cover the skin
/// many times. With a smaller part, strands are thicker where needed to cover the skin eight times (or as
/// often as the animal does, if that is less), seen from the side.
std::string groom_text(const AnimalCoat& animal, double units_per_mm, double part);

/// Returns the keys of a material that replace `preset: NAME`, as groom_text() does.
std::string material_text(const AnimalCoat& animal);

/// Returns the coat in proportion to the body, for animals of any size.
CoatLook proportional_look(const AnimalCoat& animal);

}  // namespace pelage
