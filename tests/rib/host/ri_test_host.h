// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/module.h"
#include "rib/host/plugin/ri_host.h"
#include "tests/world/furry_scene.h"

namespace pelage {

/// What a renderer has seen of a procedural and everything that it was divided into.
struct RiCalls {
  StrandsById strands;
  int procedurals = 0;  ///< nested ones
  int freed = 0;        ///< of these
  int curves = 0;       ///< calls of RiCurvesV, all keys of a motion block counted once
  int motion_blocks = 0;
  size_t colored = 0;        ///< strands with "uniform color Cs"
  std::vector<float> times;  ///< of the last motion block
  Box3f box;                 ///< of all strands
  std::vector<std::string> errors;
  std::vector<std::string> faults;  ///< of the plugin: hair beyond its box, wrong counts
};

/// A renderer that has only what the plugin needs: it loads the plugin, calls its functions in the order of
/// real renderers, and checks what the plugin hands over. The Ri functions that the plugin looks up are in
/// ri_test_host.cpp; they belong to the thread that runs a procedural.
class RiTestHost {
 public:
  RiTestHost() : plugin_("pelage_ri") {}

  /// Runs Procedural "DynamicLoad" ["libpelage_ri.so" arguments] with the given detail. Without `bound`, hair
  /// may be anywhere. `max_depth`: nested procedurals below this depth are freed without having been divided.
  RiCalls run(const std::string& arguments, float detail = 1e38f, const Box3f* bound = nullptr,
              int max_depth = 100) const;
  /// Only loads and frees.
  void convert(const std::string& arguments) const;

 private:
  Module plugin_;
};

}  // namespace pelage
