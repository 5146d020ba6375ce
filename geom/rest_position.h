// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "geom/strands.h"

namespace pelage {

/// Name of the attribute with the positions of roots on the skin at rest, for strands without RootAddress. It
/// has three components. Fields of materials use it where a coat has no skin at rest (FurPart::rest).
inline constexpr std::string_view kRestPositions = "Pref";

/// Returns the value of this attribute at the root of a strand; nullopt if the strands have none.
std::optional<V3f> rest_position(const Strands& strands, size_t strand);

}  // namespace pelage
