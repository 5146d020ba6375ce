// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/job.h"
#include "groom/operators/script_module.h"

namespace pelage {

/// A function of a script that shapes strands. Thread safety: run() may be called from any thread.
class StrandScript {
 public:
  virtual ~StrandScript() = default;
  /// Calls the function. Returns false if it fails, and then describes why in `fault`.
  virtual bool run(const PelageScriptBatch& batch, PelageScriptFault& fault) const = 0;
};

/// Where the function of a script is.
struct ScriptSource {
  std::filesystem::path file;
  std::string function;
  std::string arguments;  ///< a JSON object
};

/// Runs scripts for operators. A groom without it refuses operators that need it, because a script may do
/// whatever the user may do. Thread safety: open() may be called from any thread.
class OperatorScripts {
 public:
  virtual ~OperatorScripts() = default;
  /// Reads and runs a script. Throws Error: kInput with file and line if the file cannot be read, fails, or
  /// lacks the function; kFailed if there is no interpreter.
  virtual std::shared_ptr<const StrandScript> open(const ScriptSource& source, const Job& job) const = 0;
};

/// Returns the scripts of CPython. The first open() of the process loads the module pelage_scripts with the
/// interpreter; before, this costs nothing.
std::shared_ptr<const OperatorScripts> python_scripts();

}  // namespace pelage
