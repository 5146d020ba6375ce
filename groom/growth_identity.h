// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Hash of the sources of every room that growth is made of (base, image, geom, groom; a groom may include no
/// other), and of the compiler and its settings. Made while building, so nobody can forget to change it.
std::string_view growth_sources();

/// Tells apart programs and machines that may grow different strands, be it in the last digit:
/// growth_sources(), the system libraries that compute, and the instructions that these may choose to use.
/// Programs that differ elsewhere, in how they render, say, have the same.
std::string growth_identity();

}  // namespace pelage
