// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Returns the name of the instructions that the C library uses for sines, exponentials and other functions:
/// "x86-64", or "x86-64 FMA" on processors that multiply and add with one rounding. Pictures that were made
/// with different instructions may differ in the last digit. All other code gives the same bits with all
/// instruction sets. On x86-64, the environment variable GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA switches
/// FMA off.
const char* instruction_set();

/// Returns a text that identifies this build of the program or, if this code is in a shared library that
/// another program has loaded, of this library. Results of different builds may differ in the last digit or
/// more. The text is the linker's build id or, if there is none, a hash of the file; "unknown" when this file
/// cannot be read.
std::string program_identity();

/// Returns a text that identifies how this program computes with numbers on this machine: its compiler, the
/// libraries of functions and of subdivision, and the instruction sets among which they choose. The same code
/// may give other results, if only in the last digit, when this text differs.
std::string arithmetic_identity();

/// Returns the build id of the first loaded shared library whose file name contains `name`. Returns "none"
/// when there is no such library, "unknown" when the library has no build id.
std::string library_identity(std::string_view name);

}  // namespace pelage
