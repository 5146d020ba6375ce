// SPDX-License-Identifier: Apache-2.0
#include "base/version.h"
#include "python/bindings.h"
#include "python/errors.h"

PYBIND11_MODULE(_pelage, module) {
  module.doc() = "The compiled part of the package pelage.";
  pelage::register_errors(module);
  module.attr("version") = pelage::version();
  module.attr("compiler") = pelage::compiler();
  module.attr("libraries") = pelage::libraries();
  pelage::bind_geometry(module);
  pelage::bind_scene(module);
  pelage::bind_fibre(module);
  pelage::bind_schema(module);
}
