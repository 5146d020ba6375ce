// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage::rod_numbers {

// Numbers that both ways of stepping a rod share.

/// Stiffness beyond this many times inertia changes no result and would cost precision.
constexpr double kStiffestRod = 1e8;
/// Newton's method ends after an iteration that turns no segment by more than this, in radians.
constexpr double kConverged = 1e-3;
/// Stiffness of contacts, as a multiple of inertia.
constexpr double kContactStiffness = 1e5;

/// Largest tangent of half a twist in an iteration.
constexpr double kMaxHalfTwist = 0.5;

}  // namespace pelage::rod_numbers
