// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "image/field_nodes.h"

// Fields that are computed from other fields, channel by channel.

namespace pelage {

Field product_field(std::vector<Field> factors);
Field sum_field(std::vector<Field> terms);
Field min_field(std::vector<Field> fields);
Field max_field(std::vector<Field> fields);
/// Returns a * (1 - by) + b * by.
Field mix_field(Field a, Field b, Field by);
/// Returns 1 - field.
Field inverted_field(Field field);
/// Returns a field with the values of `field`, each channel clamped to [low, high]. Prints like `field`
/// alone: these are the limits of a key.
Field clamped_field(Field field, float low, float high);
/// Returns the same as clamped_field(), as the block `clamp` of a scene.
Field clamp_block_field(Field field, float low, float high);
/// Returns 0 below `at` and 1 from `at` on, with a smooth transition of the given width around it.
Field threshold_field(Field field, float at, float width);
/// Rounds down to multiples of `size` (> 0).
Field step_field(Field field, float size);
/// Returns the value of a curve at the value of the field. The knots have equal channels.
Field remapped_field(Field field, std::vector<RampKnot> curve);

}  // namespace pelage
