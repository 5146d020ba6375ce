// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Returns the name of the instructions that the C library uses for sines, exponentials and other functions:
/// "x86-64", or "x86-64 FMA" on processors that multiply and add with one rounding. Pictures that were made
/// with different instructions may differ in the last digit. All other code gives the same bits with all
/// instruction sets. On x86-64, the environment variable GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA switches
/// FMA off.
const char* instruction_set();

}  // namespace pelage
