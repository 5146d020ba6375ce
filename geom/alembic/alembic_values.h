// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geom/alembic/alembic_archive.h"

namespace pelage {

/// Return all numbers of a stored sample: `extent` numbers per element. Empty for compounds, texts and
/// missing samples. Numbers that a float cannot hold become infinite. Throw Error (kInput) if the sample is
/// no whole number of elements; alembic_integers() also if the numbers are not integers.
std::vector<float> alembic_floats(const AlembicArchive& archive, const AlembicProperty& property,
                                  uint32_t sample = 0);
std::vector<double> alembic_doubles(const AlembicArchive& archive, const AlembicProperty& property,
                                    uint32_t sample = 0);
std::vector<int64_t> alembic_integers(const AlembicArchive& archive, const AlembicProperty& property,
                                      uint32_t sample = 0);

/// Returns the first number of the earliest sample, without reading the others; empty if there is none or
/// the numbers are not integers.
std::optional<int64_t> alembic_first_integer(const AlembicArchive& archive, const AlembicProperty& property);

/// Returns how many numbers the functions above return.
size_t alembic_count(const AlembicArchive& archive, const AlembicProperty& property, uint32_t sample = 0);

/// Whether a property holds integers.
bool alembic_is_integer(const AlembicProperty& property);

}  // namespace pelage
