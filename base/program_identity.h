// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pelage {

/// Tells this build of the program from every other: what it computes may differ in the last digit, or in
/// more when its code has changed. The linker's build id; where there is none, a hash of the executable file.
std::string program_identity();

}  // namespace pelage
