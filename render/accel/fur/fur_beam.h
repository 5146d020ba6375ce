// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/accel/beam.h"
#include "render/accel/fur/fur_tree.h"
#include "render/accel/primitive_sink.h"

namespace pelage {

/// Finds all blocks whose boxes may meet the beam, and passes their segments to `sink`, roughly front to
/// back. Boxes contain their segments at all times of the shutter.
void visit_segments(const FurTreeView& tree, const Beam& beam, PrimitiveSink& sink);

}  // namespace pelage
