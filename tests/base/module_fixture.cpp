// SPDX-License-Identifier: Apache-2.0
// A shared library for module_test.cpp to load.
extern "C" __attribute__((visibility("default"))) int pelage_module_fixture_answer(int x) { return 2 * x; }
