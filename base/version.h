// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Version of this program, "0.1.0".
const char* version();
/// Compiler and build type: "GNU 12.2.0, Release".
const char* compiler();
/// The libraries that affect speed and results, with their versions: "Embree 3.13.5, ...".
const char* libraries();

}  // namespace pelage
