// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "image/field.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Max number of attributes that one field of a fibre material may read.
inline constexpr size_t kMaxFieldAttributes = 8;

/// A position on a strand.
struct StrandPlace {
  size_t strand = 0;
  uint32_t segment = 0;
  float u = 0;  ///< in the segment: 0 at its start, 1 at its end
  float v = 0;  ///< over the whole strand: 0 at the root, 1 at the tip
};

/// Returns the attributes that `field` reads, in the order of Field::attribute_names(). Throws Error (kInput)
/// when the strands lack one of them. `part`: name of the coat, for the message.
std::vector<const StrandAttribute*> find_attributes(const Field& field, const Strands& strands,
                                                    const std::string& part);

/// Returns the colour of a field of a fibre material at a position on a strand. `attributes`: the result of
/// find_attributes(). `rest`: FurPart::rest, may be null.
Rgb strand_color(const Field& field, const Strands& strands,
                 std::span<const StrandAttribute* const> attributes, const LimitSurface* rest,
                 const StrandPlace& place);

/// Returns whether the opacity field of a fibre material makes strands opaque everywhere.
inline bool is_opaque(const Field& opacity) { return opacity.is_constant() && opacity.value({}) >= 1; }

/// Returns the opacity at every control point; empty when it is 1 everywhere.
std::vector<float> point_opacities(const Field& opacity, const Strands& strands, const FurPart& part);

}  // namespace pelage
