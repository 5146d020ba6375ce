// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rib/document/rib_use.h"

namespace CLI {
class App;
}

namespace pelage {

/// Flags of commands that read RIB files as scenes.
struct RibUseOptions {
  std::string materials;           ///< table of materials
  bool allow_procedurals = false;  ///< run the programs that the files name
};

/// Flags of `rib` and `procedural`.
struct RibOptions {
  bool ascii = false;     ///< text instead of the binary encoding
  bool archives = false;  ///< one archive per leaf instead of procedurals
  bool expand = false;    ///< Curves instead of procedurals
  bool lod = false;       ///< only the strands that remain at the picture's level of detail
  std::string command = "pelage procedural";  ///< command of nested procedurals, in replies of `procedural`
};

/// Adds the flags of commands that read RIB files as scenes.
void add_rib_use_flags(CLI::App& command, RibUseOptions& options);
/// Returns what these flags state.
RibUse rib_use(const RibUseOptions& options);

/// Adds the flags of `rib`, except those that all commands with a scene have.
void add_rib_flags(CLI::App& rib, RibOptions& options);
/// Adds the flags of `procedural`.
void add_procedural_flags(CLI::App& procedural, RibOptions& options);

}  // namespace pelage
