// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/nearest_name.h"

namespace pelage {
namespace {

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t\n\r";
  for (size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<RibClass> class_of(std::string_view word) {
  constexpr std::string_view kNames[] = {"constant", "uniform", "varying", "vertex", "facevarying"};
  for (size_t i = 0; i < std::size(kNames); ++i) {
    if (word == kNames[i]) return static_cast<RibClass>(i);
  }
  if (word == "facevertex") return RibClass::kFaceVarying;  // of 3Delight
  return {};
}

int components_of(std::string_view type) {
  if (type == "float" || type == "integer" || type == "int" || type == "string") return 1;
  if (type == "color" || type == "point" || type == "vector" || type == "normal") return 3;
  if (type == "hpoint") return 4;
  return type == "matrix" || type == "mpoint" ? 16 : 0;
}

// The standard parameters that this reader uses or that are usual [RISPEC 3.2, table 5.1 and request texts].
struct Standard {
  const char* name;
  const char* declaration;
};
constexpr Standard kStandard[] = {
    {"P", "vertex point"},
    {"Pz", "vertex float"},
    {"Pw", "vertex hpoint"},
    {"N", "varying normal"},
    {"Np", "uniform normal"},
    {"Cs", "varying color"},
    {"Os", "varying color"},
    {"s", "varying float"},
    {"t", "varying float"},
    {"st", "varying float[2]"},
    {"width", "varying float"},
    {"constantwidth", "constant float"},
    {"id", "uniform integer"},
    {"fov", "uniform float"},
    {"Ka", "uniform float"},
    {"Kd", "uniform float"},
    {"Ks", "uniform float"},
    {"Kr", "uniform float"},
    {"roughness", "uniform float"},
    {"specularcolor", "uniform color"},
    {"texturename", "uniform string"},
    {"intensity", "uniform float"},
    {"lightcolor", "uniform color"},
    {"from", "uniform point"},
    {"to", "uniform point"},
    {"coneangle", "uniform float"},
    {"conedeltaangle", "uniform float"},
    {"beamdistribution", "uniform float"},
    {"map", "uniform string"},
    {"name", "uniform string"},
    {"gridsize", "uniform integer"},
    {"bucketsize", "uniform integer"},
    {"eyesplits", "uniform integer"},
    {"archive", "uniform string"},
    {"procedural", "uniform string"},
    {"shader", "uniform string"},
    {"texture", "uniform string"},
    {"sphere", "uniform float"},
    {"coordinatesystem", "uniform string"},
    {"endofframe", "uniform integer"},
};

bool is_whole(float x) { return std::abs(x) < 1e9f && x == std::round(x); }

bool is_integer_type(const RibDeclaration& declaration) {
  return declaration.type == "integer" || declaration.type == "int";
}

// Converts integers to floats where the type demands it, and checks the rest.
void check_type(RibStatement& request, const std::string& name, const RibDeclaration& declaration,
                RibOperand& value) {
  const bool text = declaration.type == "string" || declaration.type.starts_with(kRibReference);
  if (text != !value.is_number())
    request.fail(value, "parameter " + quote(name) + " needs " + (text ? "strings" : "numbers") + ", got " +
                            value.describe());
  if (text) return;
  if (is_integer_type(declaration) && value.kind == RibOperand::Kind::kFloats) {
    if (value.size() == 0) return;
    if (std::all_of(value.floats.begin(), value.floats.end(), is_whole)) {
      value.integers.assign(value.floats.begin(), value.floats.end());
      value.floats.clear();
      value.kind = RibOperand::Kind::kIntegers;
      return;
    }
    request.fail(value, "parameter " + quote(name) + " needs integers, got " + value.describe());
  }
  if (is_integer_type(declaration) || value.kind == RibOperand::Kind::kFloats) return;
  value.floats.assign(value.integers.begin(), value.integers.end());
  value.integers.clear();
  value.kind = RibOperand::Kind::kFloats;
}

}  // namespace

std::optional<RibDeclaration> parse_declaration(std::string_view text) {
  // "float [ 2 ]" and "float[2]" are the same.
  std::string tight;
  for (const std::string_view word : words_of(text)) {
    const bool joins = tight.empty() || word.front() == '[' || word.front() == ']' || tight.back() == '[';
    tight += (joins ? "" : " ") + std::string(word);
  }
  std::vector<std::string_view> words = words_of(tight);
  RibDeclaration declaration;
  if (!words.empty()) {
    if (const std::optional<RibClass> frequency = class_of(words.front())) {
      declaration.frequency = *frequency;
      words.erase(words.begin());
    }
  }
  const bool reference = words.size() == 2 && words[0] == "reference";
  if (words.size() != 1 && !reference) return {};
  std::string type(words.back());
  int count = 1;
  if (const size_t bracket = type.find('['); bracket != std::string::npos) {
    const char *begin = type.data() + bracket + 1, *end = type.data() + type.size();
    const auto [stop, error] = std::from_chars(begin, end, count);
    if (error != std::errc() || stop + 1 != end || *stop != ']' || count < 1 || count > 10'000) return {};
    type.resize(bracket);
  }
  declaration.components = components_of(type) * count;
  if (declaration.components == 0) return {};
  declaration.type = reference ? std::string(kRibReference) + type : std::move(type);
  if (reference) declaration.components = 1;
  return declaration;
}

RibDeclarations::RibDeclarations() {
  for (const Standard& one : kStandard) table_.emplace(one.name, *parse_declaration(one.declaration));
}

void RibDeclarations::declare(const std::string& name, const std::string& declaration,
                              const RibStatement& request) {
  const std::optional<RibDeclaration> parsed = parse_declaration(declaration);
  if (!parsed)
    request.fail(quote(declaration) +
                 " is not a declaration; expected a class and a type, such as \"varying float\"");
  table_[name] = *parsed;
}

std::vector<RibNamedValue> RibDeclarations::parameters(RibStatement& request, size_t first,
                                                       std::vector<std::string>& undeclared) const {
  std::vector<RibNamedValue> parameters;
  for (size_t i = first; i < request.arguments.size(); i += 2) {
    RibOperand& token = request.arguments[i];
    if (token.is_number() || token.is_array)
      request.fail(token, "expected the name of a parameter, got " + token.describe());
    const std::string& text = token.strings.front();
    if (i + 1 == request.arguments.size()) request.fail(token, "parameter " + quote(text) + " has no value");
    RibNamedValue parameter{text, {}, nullptr};
    const size_t blank = text.find_last_of(" \t\n\r]");  // "float[2]st" needs no blank
    if (blank == std::string::npos) {
      const auto known = table_.find(text);
      if (known == table_.end()) {
        undeclared.push_back(text);
        continue;
      }
      parameter.declaration = known->second;
    } else {
      const auto inline_declaration = parse_declaration(std::string_view(text).substr(0, blank + 1));
      if (!inline_declaration || blank + 1 == text.size()) {
        undeclared.push_back(text);
        continue;
      }
      parameter.declaration = *inline_declaration;
      parameter.name = text.substr(blank + 1);
    }
    RibOperand& value = request.arguments[i + 1];
    check_type(request, parameter.name, parameter.declaration, value);
    parameter.value = &value;
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

void project_points(RibStatement& request, std::vector<RibNamedValue>& parameters) {
  for (RibNamedValue& p : parameters) {
    if (p.name != "Pw" || p.declaration.components != 4 || find_parameter(parameters, "P")) continue;
    for (RibOperand& operand : request.arguments) {
      if (&operand != p.value) continue;
      std::vector<float>& f = operand.floats;
      for (size_t i = 0; i + 4 <= f.size(); i += 4) {
        const float w = f[i + 3] != 0 ? f[i + 3] : 1;
        for (size_t k = 0; k < 3; ++k) f[i / 4 * 3 + k] = f[i + k] / w;
      }
      f.resize(f.size() / 4 * 3);
    }
    p.name = "P";
    p.declaration.type = "point";
    p.declaration.components = 3;
  }
}

const RibNamedValue* find_parameter(const std::vector<RibNamedValue>& parameters, std::string_view name) {
  for (const RibNamedValue& parameter : parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

}  // namespace pelage
