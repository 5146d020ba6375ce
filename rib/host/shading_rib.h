// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/value.h"
#include "rib/syntax/rib_writer.h"
#include "world/scene_schema.h"

namespace pelage {

/// Writes Color and Surface. Color is the colour of the material if this is a constant, or else `mean`;
/// without either, there is no Color. The shader is "pelage_fur" for fibres and "pelage_skin" for skins. Its
/// parameters: "string name", the name of the material; one parameter for each number, colour and text of the
/// material; and "string pelage", the whole material as YAML.
///
/// `document`: the document of the scene, with absolute paths.
void write_material(RibWriter& rib, const SceneDescription& scene, const Value& document,
                    const std::string& name, const Rgb& tint, const std::optional<Rgb>& mean);

/// Writes the lights of a frame. Rectangles and spheres are AreaLightSources with a polygon or sphere in
/// world space; environments are LightSources "envlight". Parameters: "string name"; "color lightcolor", the
/// radiance; "float intensity", a factor of the radiance; "string filename" of an environment; and "string
/// pelage", the whole light as YAML. A polygon is counterclockwise as seen from its emitting side.
void write_lights(RibWriter& rib, const SceneDescription& scene, const Value& document, double frame);

}  // namespace pelage
