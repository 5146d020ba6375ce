// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Hash of the sources of every room that affects growth (base, image, geom, groom; a groom may include no
/// other), the compiler and its settings. Computed by the build, so nobody has to remember to change it.
std::string_view growth_sources();

/// Distinguishes programs and machines that may grow different strands, even in the last digit:
/// growth_sources(), the system libraries used for computation, and the instruction sets that these may
/// select. Programs that differ elsewhere, such as in rendering, have the same identity.
std::string growth_identity();

}  // namespace pelage
