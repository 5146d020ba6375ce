// SPDX-License-Identifier: Apache-2.0
// A race inside Workers::for_each, planted to see whether the thread sanitizer still sees through our loops.
// Built and run in the tsan preset only, where the test passes when the race is reported.
#include <cstdio>

#include "base/parallel.h"

int main() {
  const pelage::Workers workers(4);
  long unprotected = 0;
  workers.for_each(100'000, 1,
                   [&](pelage::WorkRange range) { unprotected += static_cast<long>(range.begin); });
  std::printf("%ld\n", unprotected);
}
