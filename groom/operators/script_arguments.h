// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/schema.h"

namespace pelage {

/// Keyword arguments of a script's function: a block whose keys the user chooses.
struct ScriptArguments {
  std::string json = "{}";  ///< a JSON object
};

template <>
struct ValueReader<ScriptArguments> {
  /// Reads a block of numbers, texts, true, false, null, lists and blocks. Keys must be Python names.
  static bool read(const Value&, const KeyOptions&, ScriptArguments& out, Problems&);
  static std::string type_name() { return "block of values"; }
  static std::string print(const ScriptArguments& v) { return v.json == "{}" ? "none" : v.json; }
};

}  // namespace pelage
