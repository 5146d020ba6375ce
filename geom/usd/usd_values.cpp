// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_values.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <type_traits>

#include <fmt/format.h>

#include "geom/usd/usda_scanner.h"

namespace pelage {
namespace {

/// Calls `use(number)` for each number of a value, and checks that each tuple has `components` numbers.
template <class T, class Use>
class NumberText {
 public:
  NumberText(const UsdLayer& layer, const UsdText& value, size_t components, const Use& use)
      : layer_(layer), end_(layer.text().data() + value.end), components_(components), use_(use) {
    for (const char* p = layer.text().data() + value.begin; p < end_;) p = step(p);
  }

 private:
  const char* step(const char* p) {
    switch (*p) {
      case ' ':
      case ',':
      case '\n':
      case '\r':
      case '\t':
      case '[':
      case ']':
        return p + 1;
      case '(':
        if (depth_++ == 0) in_tuple_ = 0;
        return p + 1;
      case ')':
        if (--depth_ == 0 && in_tuple_ != components_) fail_count(p);
        return p + 1;
      case '/':
        return comment(p);
      case '#':
        return std::find(p, end_, '\n');
      default:
        return number(p);
    }
  }

  const char* comment(const char* p) {
    const std::string_view rest(p, static_cast<size_t>(end_ - p));
    if (rest.starts_with("//")) return std::find(p, end_, '\n');
    const size_t end = rest.starts_with("/*") ? rest.find("*/", 2) : std::string_view::npos;
    if (end == std::string_view::npos) fail(p, "expected a number");
    return p + end + 2;
  }

  const char* number(const char* p) {
    if ((components_ > 1) != (depth_ > 0)) fail_count(p);
    if (*p == '+') ++p;
    T value = 0;
    const auto [end, error] = std::from_chars(p, end_, value);
    if (error == std::errc::invalid_argument) return word(p);
    if (error != std::errc()) value = out_of_range(p, end);
    if (end < end_ && !is_end(*end)) fail(end, "expected a number");
    ++in_tuple_;
    use_(value);
    return end;
  }

  T out_of_range(const char* p, const char* end) {
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(std::strtod(std::string(p, end).c_str(), nullptr));
    } else {
      fail(p, "the number is too large");
    }
  }

  /// Values of bool may be words.
  const char* word(const char* p) {
    const std::string_view rest(p, static_cast<size_t>(end_ - p));
    for (const auto& [name, value] : {std::pair<std::string_view, int>{"true", 1}, {"false", 0}}) {
      if (!rest.starts_with(name)) continue;
      use_(static_cast<T>(value));
      return p + name.size();
    }
    fail(p, "expected a number");
  }

  static bool is_end(char c) {
    return c == ',' || c == ')' || c == ']' || c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '#' ||
           c == '/';
  }
  [[noreturn]] void fail(const char* p, const std::string& message) {
    layer_.fail(static_cast<size_t>(p - layer_.text().data()), message);
  }
  [[noreturn]] void fail_count(const char* p) {
    fail(p, components_ == 1 ? "expected a number, found a tuple"
                             : fmt::format("expected tuples of {} numbers", components_));
  }

  const UsdLayer& layer_;
  const char* const end_;
  const size_t components_;
  const Use& use_;
  int depth_ = 0;
  size_t in_tuple_ = 0;
};

template <class T>
std::vector<T> numbers_of_text(const UsdLayer& layer, const UsdText& value, size_t components) {
  std::vector<T> numbers;
  // A number has at least two characters, and mostly about ten.
  numbers.reserve((value.end - value.begin) / 10);
  const auto add = [&](T number) { numbers.push_back(number); };
  NumberText<T, decltype(add)>(layer, value, components, add);
  return numbers;
}

}  // namespace

size_t usd_components(std::string_view type) {
  if (type == "matrix4d") return 16;
  if (type == "matrix3d") return 9;
  if (type == "matrix2d") return 4;
  if (type.starts_with("quat")) return 4;
  if (type == "bool" || type == "uchar" || type == "int" || type == "uint" || type == "int64" ||
      type == "uint64" || type == "half" || type == "float" || type == "double" || type == "timecode")
    return 1;
  if (type.size() < 2) return 0;
  std::string_view base = type;
  const char last = base.back();
  constexpr std::string_view kRoles[] = {"point", "vector", "normal", "color", "texCoord"};
  for (const std::string_view role : kRoles) {
    if (!base.starts_with(role) || (last != 'f' && last != 'd' && last != 'h')) continue;
    const char digit = base[base.size() - 2];
    return digit >= '2' && digit <= '4' ? static_cast<size_t>(digit - '0') : 0;
  }
  if (last < '2' || last > '4') return 0;
  base.remove_suffix(1);
  const bool known = base == "int" || base == "half" || base == "float" || base == "double";
  return known ? static_cast<size_t>(last - '0') : 0;
}

std::vector<float> usd_floats(const UsdLayer& layer, const UsdText& value, size_t components) {
  return numbers_of_text<float>(layer, value, components);
}
std::vector<double> usd_doubles(const UsdLayer& layer, const UsdText& value, size_t components) {
  return numbers_of_text<double>(layer, value, components);
}
std::vector<int64_t> usd_integers(const UsdLayer& layer, const UsdText& value) {
  return numbers_of_text<int64_t>(layer, value, 1);
}

size_t usd_count(const UsdLayer& layer, const UsdText& value, size_t components) {
  size_t count = 0;
  const auto add = [&](double) { ++count; };
  NumberText<double, decltype(add)>(layer, value, components, add);
  return components > 0 ? count / components : 0;
}

std::vector<std::string> usd_texts(const UsdLayer& layer, const UsdText& value) {
  UsdaScanner in(layer, value.begin, value.end);
  std::vector<std::string> texts;
  if (!in.accept('[')) return {in.quoted()};
  while (!in.accept(']')) {
    if (in.accept(',')) continue;
    texts.push_back(in.quoted());
  }
  return texts;
}

}  // namespace pelage
