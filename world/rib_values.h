// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/value.h"
#include "base/vector.h"
#include "procedurals/rib/rib_scene.h"

namespace pelage {

// Values of a scene document that come from a RIB file.

Value rib_text(const SourcePosition& position, std::string text);
Value rib_number(const SourcePosition& position, double number);
Value rib_vector(const SourcePosition& position, const V3f& v);
void add_entry(Value& map, std::string key, Value value);

/// Parses the YAML text of a setting that Pelage wrote: a block. All positions in it are that of the setting.
/// Throws Error (kInput).
Value rib_block(const RibSetting& setting);

/// Returns the block of a material, and appends a warning if its shader is not known.
Value rib_material(const RibMaterial& material, std::vector<Problem>& warnings);
/// Returns the block of a light; empty, with a warning, if it is not supported.
std::optional<Value> rib_light(const RibLight& light, std::vector<Problem>& warnings);

}  // namespace pelage
