// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/script_arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/value_readers.h"

namespace pelage {
namespace {

std::string json_text(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') json += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      json += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      json += c;
    }
  }
  return json + '"';
}

bool is_python_name(std::string_view key) {
  const auto is_letter = [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !key.empty() && is_letter(key.front()) &&
         std::all_of(key.begin(), key.end(), [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

/// Whole numbers stay whole, and 2.0 or 1e3 become floating-point numbers of Python.
std::string number_text(std::string_view text, double number) {
  if (text.find_first_of(".eE") == std::string::npos && std::abs(number) < 1e15)
    return fmt::format("{:.0f}", number);
  std::string json = fmt::format("{:.17g}", number);  // 17 digits give every double back
  if (json.find_first_of(".e") == std::string::npos) json += ".0";
  return json;
}

/// Whether a text is YAML for a number that JSON lacks, or a number that is too large.
bool is_not_finite(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  for (const char* name : {".nan", ".NaN", ".NAN", ".inf", ".Inf", ".INF"}) {
    if (text == name) return true;
  }
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc::result_out_of_range && read.ptr == text.data() + text.size();
}

bool add_json(const Value& value, std::string& json, Problems& problems);

bool add_scalar(const Value& value, std::string& json, Problems& problems) {
  const std::string& text = value.text();
  if (value.data()) {
    problems.add(value.position(), "expected numbers or texts, got " + value.describe());
    return false;
  }
  if (value.quoted()) {
    json += json_text(text);
  } else if (const std::optional<double> number = parse_number(text)) {
    json += number_text(text, *number);
  } else if (is_not_finite(text)) {
    problems.add(value.position(), "expected a finite number, got " + text);
    return false;
  } else if (text == "true" || text == "True" || text == "TRUE") {
    json += "true";
  } else if (text == "false" || text == "False" || text == "FALSE") {
    json += "false";
  } else {
    json += json_text(text);
  }
  return true;
}

bool add_block(const Value& value, std::string& json, Problems& problems) {
  bool good = true;
  json += "{";
  for (const Value::Entry& entry : value.entries()) {
    if (json.back() != '{') json += ", ";
    json += json_text(entry.key) + ": ";
    good &= add_json(entry.value, json, problems);
  }
  json += "}";
  return good;
}

bool add_json(const Value& value, std::string& json, Problems& problems) {
  if (value.is_null()) {
    json += "null";
    return true;
  }
  if (value.is_scalar()) return add_scalar(value, json, problems);
  if (value.is_map()) return add_block(value, json, problems);
  bool good = true;
  json += "[";
  for (const Value& item : value.items()) {
    if (json.back() != '[') json += ", ";
    good &= add_json(item, json, problems);
  }
  json += "]";
  return good;
}

}  // namespace

bool ValueReader<ScriptArguments>::read(const Value& value, const KeyOptions&, ScriptArguments& out,
                                        Problems& problems) {
  if (!value.is_map()) {
    problems.add(value.position(), "expected a block of values, got " + value.describe());
    return false;
  }
  bool good = true;
  for (const Value::Entry& entry : value.entries()) {
    if (is_python_name(entry.key)) continue;
    problems.add(entry.key_position, "expected the name of an argument, got " + quote(entry.key));
    good = false;
  }
  std::string json;
  good &= add_block(value, json, problems);
  if (good) out.json = std::move(json);
  return good;
}

}  // namespace pelage
