// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace pelage {

// Each adds some classes and functions to the module `_pelage`, which the files of pelage/ make into the
// package.
void bind_geometry(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_fibre(pybind11::module_& module);
void bind_schema(pybind11::module_& module);

}  // namespace pelage
