// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "geom/usd/usd_layer.h"

namespace pelage {

/// Reads the tokens of a .usda text. Throws Error (kInput) with line and column where the text is not what a
/// member expects.
class UsdaScanner {
 public:
  UsdaScanner(const UsdLayer& layer, size_t begin, size_t end)
      : layer_(layer), text_(layer.text().substr(0, end)), at_(begin) {}

  /// Skips spaces, line ends and comments. Returns the next character, or 0 at the end of the text.
  char next();
  size_t place() const { return at_; }
  /// Takes a character if it is next.
  bool accept(char c);
  void expect(char c);
  /// Whether a name is next: letters, digits, _ and, between names, colons.
  bool at_name();
  std::string_view name();
  /// Text in quotes of any of the four kinds.
  std::string quoted();
  /// File between @.
  std::string asset();
  /// Path of a prim or property between < and >.
  std::string path();
  double number();
  /// Skips a value: a word, a number, a text, an asset, a path, or everything up to a closing bracket.
  UsdText skip_value();
  [[noreturn]] void fail(const std::string& message) const { layer_.fail(at_, message); }
  [[noreturn]] void fail_expected(const std::string& what);

 private:
  void skip_line();
  /// Skips a comment that begins with a slash. Returns false if none is here.
  bool skip_comment();
  void skip_quoted();
  void skip_asset();
  void skip_brackets();

  const UsdLayer& layer_;
  const std::string_view text_;
  size_t at_;
};

}  // namespace pelage
