// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pelage {

/// The main() of a program: prepares the process, calls `run` with the arguments, and shows its errors.
/// Returns the exit code: that of `run`, or of its error, or 1 if the output could not be written.
int run_program(int argc, char** argv, const std::function<int(const std::vector<std::string>&)>& run);

}  // namespace pelage
