// SPDX-License-Identifier: Apache-2.0
#include "base/value_readers.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/nearest_name.h"

namespace pelage {
namespace {

// Removes single underscores between digits; anything else that is malformed stays so.
std::string without_underscores(std::string_view text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool between_digits = i > 0 && i + 1 < text.size() &&
                                std::isdigit(static_cast<unsigned char>(text[i - 1])) &&
                                std::isdigit(static_cast<unsigned char>(text[i + 1]));
    if (text[i] != '_' || !between_digits) plain += text[i];
  }
  return plain;
}

std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

std::optional<int64_t> parse_integer(std::string_view text) {
  const std::string plain = without_underscores(without_plus(text));
  int64_t exact = 0;
  const char* end = plain.data() + plain.size();
  if (const auto result = std::from_chars(plain.data(), end, exact);
      result.ec == std::errc() && result.ptr == end) {
    return exact;
  }
  // 1e6 and 3.0 are integers too; beyond 2^53 a double is not exact.
  const std::optional<double> number = parse_number(text);
  if (!number || *number != std::floor(*number) || std::abs(*number) > 0x1p53) return {};
  return static_cast<int64_t>(*number);
}

bool in_range(double number, const KeyOptions& options) {
  if (options.above_min ? number <= options.min : number < options.min) return false;
  return number <= options.max;
}

// "a number > 0"
std::string expected(const std::string& what, const KeyOptions& options) {
  const std::string range = range_text(options);
  return "expected " + what + (range.empty() ? "" : " " + range) + ", got ";
}

bool read_number(const Value& value, const KeyOptions& options, double largest, double& out,
                 Problems& problems) {
  const std::optional<double> number =
      value.is_scalar() && !value.quoted() ? parse_number(value.text()) : std::nullopt;
  if (!number || !in_range(*number, options) || std::abs(*number) > largest) {
    problems.add(value.position(),
                 expected("a number", options) + (number ? value.text() : value.describe()));
    return false;
  }
  out = *number;
  return true;
}

bool read_whole(const Value& value, const KeyOptions& options, int64_t min, int64_t max, int64_t& out,
                Problems& problems) {
  const std::optional<int64_t> number =
      value.is_scalar() && !value.quoted() ? parse_integer(value.text()) : std::nullopt;
  if (!number || *number < min || *number > max || !in_range(static_cast<double>(*number), options)) {
    problems.add(value.position(),
                 expected("a whole number", options) + (number ? value.text() : value.describe()));
    return false;
  }
  out = *number;
  return true;
}

template <class Vector>
bool read_vector(const Value& value, const KeyOptions& options, int size, Vector& out, Problems& problems) {
  if (!value.is_list() || value.items().size() != static_cast<size_t>(size)) {
    problems.add(value.position(),
                 "expected a list of " + std::to_string(size) + " numbers, got " + value.describe());
    return false;
  }
  Vector result = out;
  bool good = true;
  for (int i = 0; i < size; ++i) {
    good &= ValueReader<float>::read(value.items()[static_cast<size_t>(i)], options, result[i], problems);
  }
  if (good) out = result;
  return good;
}

template <class Vector>
std::string print_vector(const Vector& v, int size) {
  std::string text = "[";
  for (int i = 0; i < size; ++i) text += (i ? ", " : "") + ValueReader<float>::print(v[i]);
  return text + "]";
}

template <class Number>
std::string shortest(Number number) {
  char buffer[64];
  char* const end = buffer + sizeof buffer;
  if constexpr (std::is_floating_point_v<Number>) {
    // 1000000, not 1e+06.
    if (std::abs(number) < Number(1e15) && number == std::floor(number)) {
      return std::string(buffer, std::to_chars(buffer, end, number, std::chars_format::fixed).ptr);
    }
  }
  return std::string(buffer, std::to_chars(buffer, end, number).ptr);
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::string plain = without_underscores(without_plus(text));
  if (plain.empty() || plain.find_first_not_of("0123456789.+-eE") != std::string::npos) return {};
  double number = 0;
  const char* end = plain.data() + plain.size();
  const auto result = std::from_chars(plain.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return {};
  return number;
}

std::optional<uint64_t> parse_bytes(std::string_view text) {
  constexpr std::string_view kUnits = "KMGT";
  if (text.ends_with("iB")) {
    text.remove_suffix(2);
  } else if (text.ends_with('B')) {
    text.remove_suffix(1);
  }
  double factor = 1;
  if (!text.empty()) {
    if (const size_t unit = kUnits.find(text.back()); unit != std::string_view::npos) {
      factor = std::ldexp(1.0, 10 * (static_cast<int>(unit) + 1));
      text.remove_suffix(1);
    }
  }
  const std::optional<double> number = parse_number(text);
  if (!number || *number < 0 || *number * factor >= 0x1p63) return {};
  return static_cast<uint64_t>(*number * factor);
}

bool ValueReader<double>::read(const Value& value, const KeyOptions& options, double& out,
                               Problems& problems) {
  return read_number(value, options, std::numeric_limits<double>::max(), out, problems);
}
std::string ValueReader<double>::print(const double& v) { return shortest(v); }

bool ValueReader<float>::read(const Value& value, const KeyOptions& options, float& out, Problems& problems) {
  double number = 0;
  if (!read_number(value, options, std::numeric_limits<float>::max(), number, problems)) return false;
  out = static_cast<float>(number);
  return true;
}
std::string ValueReader<float>::print(const float& v) { return shortest(v); }

bool ValueReader<int64_t>::read(const Value& value, const KeyOptions& options, int64_t& out,
                                Problems& problems) {
  return read_whole(value, options, std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max(),
                    out, problems);
}
std::string ValueReader<int64_t>::print(const int64_t& v) { return shortest(v); }

bool ValueReader<int>::read(const Value& value, const KeyOptions& options, int& out, Problems& problems) {
  int64_t number = 0;
  if (!read_whole(value, options, std::numeric_limits<int>::min(), std::numeric_limits<int>::max(), number,
                  problems)) {
    return false;
  }
  out = static_cast<int>(number);
  return true;
}
std::string ValueReader<int>::print(const int& v) { return shortest(v); }

bool ValueReader<bool>::read(const Value& value, const KeyOptions&, bool& out, Problems& problems) {
  if (value.is_scalar() && !value.quoted() && (value.text() == "true" || value.text() == "false")) {
    out = value.text() == "true";
    return true;
  }
  problems.add(value.position(), "expected true or false, got " + value.describe());
  return false;
}
std::string ValueReader<bool>::print(const bool& v) { return v ? "true" : "false"; }

bool ValueReader<std::string>::read(const Value& value, const KeyOptions&, std::string& out,
                                    Problems& problems) {
  if (!value.is_scalar()) {
    problems.add(value.position(), "expected text, got " + value.describe());
    return false;
  }
  out = value.text();
  return true;
}
std::string ValueReader<std::string>::print(const std::string& v) { return v.empty() ? "none" : v; }

bool ValueReader<AssetPath>::read(const Value& value, const KeyOptions&, AssetPath& out, Problems& problems) {
  if (!value.is_scalar() || value.text().empty() || value.text().find('\0') != std::string::npos) {
    problems.add(value.position(), "expected a file name, got " + value.describe());
    return false;
  }
  std::filesystem::path path = value.text();
  if (value.data()) {
    out = {std::move(path), value.position(), value.data()};
    return true;
  }
  // A value without a line comes from the command line: its path is relative to the current folder.
  if (path.is_relative() && value.position().line > 0) {
    path = (std::filesystem::path(value.position().file).parent_path() / path).lexically_normal();
  }
  out = {std::move(path), value.position()};
  return true;
}
std::string ValueReader<AssetPath>::print(const AssetPath& v) { return v.empty() ? "none" : v.path.string(); }

bool ValueReader<NameReference>::read(const Value& value, const KeyOptions&, NameReference& out,
                                      Problems& problems) {
  if (!value.is_scalar() || value.text().empty()) {
    problems.add(value.position(), "expected a name, got " + value.describe());
    return false;
  }
  out = {value.text(), value.position()};
  return true;
}

bool ValueReader<ByteSize>::read(const Value& value, const KeyOptions& options, ByteSize& out,
                                 Problems& problems) {
  const std::optional<uint64_t> bytes = value.is_scalar() ? parse_bytes(value.text()) : std::nullopt;
  if (!bytes || !in_range(static_cast<double>(*bytes), options)) {
    problems.add(value.position(), "expected bytes such as 512M or 4G, got " + value.describe());
    return false;
  }
  out.bytes = *bytes;
  return true;
}
std::string ValueReader<ByteSize>::print(const ByteSize& v) {
  constexpr const char* kUnits[] = {"", "K", "M", "G", "T"};
  uint64_t bytes = v.bytes;
  size_t unit = 0;
  while (bytes != 0 && bytes % 1024 == 0 && unit + 1 < std::size(kUnits)) {
    bytes /= 1024;
    ++unit;
  }
  return std::to_string(bytes) + kUnits[unit];
}

bool ValueReader<V2f>::read(const Value& value, const KeyOptions& options, V2f& out, Problems& problems) {
  return read_vector(value, options, 2, out, problems);
}
std::string ValueReader<V2f>::print(const V2f& v) { return print_vector(v, 2); }

bool ValueReader<V3f>::read(const Value& value, const KeyOptions& options, V3f& out, Problems& problems) {
  return read_vector(value, options, 3, out, problems);
}
std::string ValueReader<V3f>::print(const V3f& v) { return print_vector(v, 3); }

bool ValueReader<Rgb>::read(const Value& value, const KeyOptions& options, Rgb& out, Problems& problems) {
  if (value.is_list() && value.items().size() == 3) return read_vector(value, options, 3, out, problems);
  float grey = 0;
  if (value.is_scalar() && !value.quoted() && parse_number(value.text())) {
    if (!ValueReader<float>::read(value, options, grey, problems)) return false;
    out = Rgb(grey);
    return true;
  }
  problems.add(value.position(), "expected a colour, [r, g, b] or one number, got " + value.describe());
  return false;
}
std::string ValueReader<Rgb>::print(const Rgb& v) { return print_vector(v, 3); }

namespace detail {

bool read_enum(const Value& value, std::span<const char* const> names, const KeyOptions& options, int& out,
               Problems& problems) {
  if (value.is_scalar()) {
    for (size_t i = 0; i < names.size(); ++i) {
      if (value.text() != names[i]) continue;
      out = static_cast<int>(i);
      return true;
    }
    if (value.text() == options.removed.name && !value.text().empty()) {
      problems.add(value.position(),
                   quote(value.text()) + " was removed: " + std::string(options.removed.advice));
      return false;
    }
  }
  const std::vector<std::string> candidates(names.begin(), names.end());
  std::string message = "expected " + enum_type_name(names) + ", got " + value.describe();
  if (value.is_scalar()) message += did_you_mean(value.text(), candidates);
  problems.add(value.position(), std::move(message));
  return false;
}

std::string enum_type_name(std::span<const char* const> names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) text += (i ? " | " : "") + std::string(names[i]);
  return text;
}

const Value* find_type(const Value& block, const char* key, std::span<const std::string> kinds,
                       Problems& problems) {
  std::string list;
  for (size_t i = 0; i < kinds.size(); ++i) list += (i ? " | " : "") + kinds[i];
  if (!block.is_map()) {
    problems.add(block.position(),
                 "expected a block with '" + std::string(key) + ": " + list + "', got " + block.describe());
    return nullptr;
  }
  const Value* type = block.find(key);
  if (type == nullptr) {
    problems.add(block.position(), "the block needs the key '" + std::string(key) + "': " + list);
    return nullptr;
  }
  if (!type->is_scalar() || std::find(kinds.begin(), kinds.end(), type->text()) == kinds.end()) {
    std::string message = "expected " + list + ", got " + type->describe();
    if (type->is_scalar()) message += did_you_mean(type->text(), kinds);
    problems.add(type->position(), std::move(message));
    return nullptr;
  }
  return type;
}

}  // namespace detail
}  // namespace pelage
