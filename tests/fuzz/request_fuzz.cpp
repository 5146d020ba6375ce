// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"
#include "base/error.h"
#include "tests/fuzz/fuzz_targets.h"
#include "world/hair_arguments.h"

namespace pelage {

void fuzz_request(std::span<const uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    const std::string printed = print_hair_arguments(parse_hair_arguments(text));
    PELAGE_CHECK(print_hair_arguments(parse_hair_arguments(printed)) == printed);
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kArguments);
  }
}

}  // namespace pelage
