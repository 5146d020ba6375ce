// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rib/syntax/rib_reader.h"

namespace pelage {

/// Begin of RibDeclaration::type for a parameter that a pattern computes: "reference color". The values are
/// strings, such as "pattern:output".
inline constexpr std::string_view kRibReference = "reference ";

/// How many values a parameter has.
enum class RibClass { kConstant, kUniform, kVarying, kVertex, kFaceVarying };

/// Type of a parameter: "varying float[2] width".
struct RibDeclaration {
  RibClass frequency = RibClass::kUniform;
  std::string type = "float";
  int components = 1;  ///< numbers or strings per value
};

/// A parameter of a request. `value` belongs to the request.
struct RibNamedValue {
  std::string name;
  RibDeclaration declaration;
  const RibOperand* value = nullptr;
};

/// The declared types of parameters: the standard ones, those of Declare, and inline declarations.
class RibDeclarations {
 public:
  RibDeclarations();
  /// Request Declare. Throws Error (kInput) if the declaration is malformed.
  void declare(const std::string& name, const std::string& declaration, const RibStatement& request);
  /// Returns the parameters among the arguments of a request, from argument `first` on. Numbers of integers
  /// become floats where the declaration demands floats. Throws Error (kInput) for a parameter without a
  /// value, and for a value of the wrong type. `undeclared`: receives the names of parameters that nothing
  /// declares or whose declaration is malformed; such parameters are not returned.
  std::vector<RibNamedValue> parameters(RibStatement& request, size_t first,
                                        std::vector<std::string>& undeclared) const;

 private:
  std::map<std::string, RibDeclaration, std::less<>> table_;
};

/// Parses "class type[n]", where the class may be missing. Returns nullopt if it is malformed.
std::optional<RibDeclaration> parse_declaration(std::string_view text);

/// Converts "Pw", points with weights, to "P", unless there is a "P".
void project_points(RibStatement& request, std::vector<RibNamedValue>& parameters);

/// Returns the parameter of this name; null when there is none.
const RibNamedValue* find_parameter(const std::vector<RibNamedValue>& parameters, std::string_view name);

}  // namespace pelage
