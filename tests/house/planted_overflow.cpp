// SPDX-License-Identifier: Apache-2.0
// A read past the end or a signed overflow, as the argument says, planted to see whether the address and the
// undefined-behaviour sanitizers still stop our code. Built and run in the asan preset only.
#include <climits>
#include <cstdio>
#include <cstring>
#include <vector>

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "heap") == 0) {
    const std::vector<int> values(static_cast<size_t>(argc));
    std::printf("%d\n", values.data()[argc]);
  } else {
    std::printf("%d\n", INT_MAX - 1 + argc);
  }
}
