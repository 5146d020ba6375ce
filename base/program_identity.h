// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Identifies this build of the program, because other builds may compute results that differ in the last
/// digit or more. The linker's build id or, if there is none, a hash of the executable file.
std::string program_identity();

/// The same for a shared library that the program was started with, given a part of its file name; "none"
/// when there is no such library, "unknown" when it has no build id.
std::string library_identity(std::string_view name);

}  // namespace pelage
