// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"

namespace pelage {

/// Replaces `preset: NAME` of grooms, and of materials without a `model`, by the keys of the preset
/// (starter/animal_preset.h), scaled by `units`. The scene then is the same as if these keys were written
/// out.
///
/// Keys of the scene override the preset's, and blocks are merged key by key. In `operators`, the first
/// operator of each name changes the preset's operator of this name; operators that the preset does not have,
/// and repeated ones, follow in order. A groom with `strands` or `strands_file` does not take the density.
///
/// With a `model` of its own, a material takes only the colour of the animal, or its pigments if the model
/// has them. A name that is a preset of this model itself keeps that meaning.
///
/// Adds a problem for each unknown name, with the nearest known one, and for a preset that is no name.
void expand_presets(Value& document, Problems& problems);

}  // namespace pelage
