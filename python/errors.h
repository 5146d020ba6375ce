// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace pelage {

/// Turns pelage::Error into pelage.Error of the package, which has the problems with their positions. Adds
/// suggest(), see base/nearest_name.h.
void register_errors(pybind11::module_& module);

}  // namespace pelage
