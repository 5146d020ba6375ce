// SPDX-License-Identifier: Apache-2.0
#include "base/instruction_set.h"

#if defined(__x86_64__) && defined(__GLIBC__)
#include <sys/platform/x86.h>
#endif

namespace pelage {

const char* instruction_set() {
#if defined(__x86_64__) && defined(__GLIBC__)
  // What the library uses, rather than what the processor has.
  return CPU_FEATURE_ACTIVE(FMA) && CPU_FEATURE_ACTIVE(AVX2) ? "x86-64 FMA" : "x86-64";
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "unknown";
#endif
}

}  // namespace pelage
