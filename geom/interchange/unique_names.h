// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>

namespace pelage {

/// Returns a name with _ in place of the characters that identifiers cannot have: letters, digits and _ stay,
/// and a digit does not come first. Every format of other programs accepts such names.
std::string identifier(std::string_view text);

/// Gives names to the objects of one parent: no two are equal.
class UniqueNames {
 public:
  /// Returns identifier(text), with a number behind it if an earlier call returned this name.
  std::string unique(std::string_view text);

 private:
  std::set<std::string, std::less<>> used_;
};

}  // namespace pelage
