// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/groom.h"

namespace pelage {

class Workers;

/// Returns the mean distance between the roots of strands that do not grow on a skin, at rest, for a
/// character of scale 1: 1 / sqrt(roots per area), where the area is that of a disc around a root that
/// contains its 8 nearest roots, averaged over 32 roots. Does not depend on how the groom is divided into
/// leaves. Returns 0 if there are fewer than 9 roots.
float root_spacing(const Groom& groom, const Workers& workers);

}  // namespace pelage
