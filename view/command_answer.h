// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pelage {

/// The answer to a command or a question: a status code of HTTP and an object of JSON, with the key "error"
/// unless the status is 200.
struct CommandAnswer {
  int status = 200;
  std::string json;
};

}  // namespace pelage
