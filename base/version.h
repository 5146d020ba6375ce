// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Returns the version of this program: "0.1.0".
const char* version();
/// Number that is incremented whenever a public type of docs/LIBRARY.md changes its layout, or a public
/// function its parameters or its meaning. A host that compares this constant, which its compiler saw, with
/// library_abi(), which the linked library returns, notices headers of another release.
inline constexpr int kLibraryAbi = 1;
int library_abi();
/// Returns the compiler and build type: "GNU 12.2.0, Release".
const char* compiler();
/// Returns the libraries that affect speed or results, with their versions: "Embree 3.13.5, ...".
const char* libraries();

}  // namespace pelage
