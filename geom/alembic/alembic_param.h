// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "geom/alembic/alembic_scene.h"
#include "geom/interchange/primvar.h"

namespace pelage {

/// Reads the earliest sample of a parameter of numbers with its scope, indexed or not. Returns nothing if it
/// has no values or is not of numbers, or, with a warning, if its elements have more than
/// kMaxPrimvarComponents numbers. If the scope does not fit the number of values, uses the interpolation that
/// fits. If none fits, returns nothing, with a warning; but if the parameter is `needed`, throws Error
/// (kInput) with the path of the object. Also throws it if an index is out of range.
std::optional<Primvar> alembic_param(const AlembicNode& node, const AlembicProperty& property,
                                     const PrimvarCounts& counts, ReadWarnings& warnings,
                                     bool needed = false);

/// Returns the max memory that alembic_param() takes, in bytes, without reading the numbers.
size_t alembic_param_bytes(const AlembicArchive& archive, const AlembicProperty& property);

}  // namespace pelage
