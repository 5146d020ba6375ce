// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Returns the version of this program: "0.1.0".
const char* version();
/// Returns the compiler and build type: "GNU 12.2.0, Release".
const char* compiler();
/// Returns the libraries that affect speed or results, with their versions: "Embree 3.13.5, ...".
const char* libraries();

}  // namespace pelage
