// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Returns a hash of the compiler, its settings, and the sources of every module that affects growth: base,
/// image, geom and groom. A groom may include no other modules. The build computes this hash, so no developer
/// has to update it.
std::string_view growth_sources();

/// Returns a text that identifies how this program computes strands on this machine. If two programs or
/// machines may grow strands that differ, if only in the last digit, their texts differ. It consists of
/// growth_sources(), the system libraries used for computation, and the instruction sets among which these
/// libraries may choose. Programs that differ only in other modules, such as rendering, return the same text.
std::string growth_identity();

}  // namespace pelage
