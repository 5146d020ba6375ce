// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "base/value.h"
#include "scene/document.h"

namespace pelage {

/// Converts what pelage/_values.py makes of a value of the user: None, str, list, dict with keys of type str,
/// MeshData, PoseData, ImageData or StrandData. `path`: keys that lead to the value; the position of the
/// result. Throws pybind11::type_error for anything else, and for nesting deeper than 64.
Value to_value(pybind11::handle object, const std::string& path, int depth = 0);

/// Converts a dict from keys "a.b.c" to such values.
std::vector<Override> to_overrides(const pybind11::dict& changes);

}  // namespace pelage
