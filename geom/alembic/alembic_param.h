// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "geom/alembic/alembic_scene.h"
#include "geom/usd/usd_primvar.h"

namespace pelage {

/// Reads the earliest sample of a parameter of numbers with its scope, indexed or not; empty if it has no
/// values, is not of numbers, or has elements of more than 16 numbers, which gives a warning. If the scope
/// does not fit the number of values, the interpolation is the one that fits; if none fits, returns nothing
/// with a warning. `needed`: whether that is an error. Throws Error (kInput) with the path of the object
/// then, or if an index is out of range.
std::optional<UsdPrimvar> alembic_param(const AlembicNode& node, const AlembicProperty& property,
                                        const UsdPrimvarCounts& counts, UsdWarnings& warnings,
                                        bool needed = false);

/// Returns the max memory that alembic_param() takes, in bytes, without reading the numbers.
size_t alembic_param_bytes(const AlembicArchive& archive, const AlembicProperty& property);

}  // namespace pelage
