// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world/coat_motion.h"

namespace pelage {

/// Returns the guides of a coat at a frame as strands in world space, where `dynamics` moves them, in the
/// order of Groom::guides(). FileMotion reads them again. `turns`: at this frame; empty: the guides follow
/// their skin rigidly. The strands have no widths.
Strands guide_strands(const Assets& assets, const MovingCoat& coat, double frame, const GuideTurns& turns,
                      const Job& job);

}  // namespace pelage
