// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Tells this build of the program from every other: what it computes may differ in the last digit, or in
/// more when its code has changed. The linker's build id; where there is none, a hash of the executable file.
std::string program_identity();

/// The same of a shared library that the program was started with, by a part of its file name; "none" when
/// there is none such, "unknown" when it does not say.
std::string library_identity(std::string_view name);

}  // namespace pelage
