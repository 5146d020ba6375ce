// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "geom/skin_lattice.h"
#include "geom/tessellation.h"

namespace pelage {

class Workers;

/// Sets the rate of every line of a lattice from the max length of the line on screen over the rated keys
/// (TessellationOptions). Flat triangles are not divided. `check_stop` is called every few hundred lines, by
/// any thread.
void set_rates(
    SkinLattice& lattice, std::span<const LimitSurface> keys, const View& view,
    const TessellationOptions& options, const Workers& workers,
    const std::function<void()>& check_stop = [] {});

}  // namespace pelage
