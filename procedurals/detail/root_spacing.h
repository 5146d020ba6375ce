// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/groom.h"

namespace pelage {

class Workers;

/// Returns the mean distance between the roots of strands that do not grow on a skin: at rest, for a
/// character of scale 1. It is the square root of the mean area per root. The area per root is measured at 32
/// roots: an eighth of the disc that contains the 8 nearest other roots. The result does not depend on
/// leaves. Returns 0 if there are fewer than 9 roots.
float root_spacing(const Groom& groom, const Workers& workers);

}  // namespace pelage
