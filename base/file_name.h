// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pelage {

/// Returns the name of a file for something that `parts` name, such as the archives of a coat:
/// {"rat", "under", "3"} becomes "rat.under.3". Every name of a scene that becomes the name of a file or
/// folder goes through this function, because names may contain anything.
///
/// Different parts have different names. A name is never "." or "..", contains no slash, begins with neither
/// a dot nor a dash, and has at most 120 bytes. Characters other than ASCII letters, digits, '-' and '_' are
/// written as "=2F". Of a longer name, the first 80 bytes remain, followed by a hash of the parts.
std::string file_name_of(const std::vector<std::string>& parts);

}  // namespace pelage
