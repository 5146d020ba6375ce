// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace pelage {

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "pelage: bug: %s:%d: this must hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace pelage
