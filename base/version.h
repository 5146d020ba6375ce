// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Version of this program, "0.1.0".
const char* version();
/// What it was built with and how: "GNU 12.2.0, Release".
const char* compiler();
/// The libraries that decide speed and numbers, with their versions: "Embree 3.13.5, ...".
const char* libraries();

}  // namespace pelage
