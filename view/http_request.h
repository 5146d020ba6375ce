// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pelage {

/// A request to the server, after its head or after its body has been read.
struct HttpRequest {
  std::string method;                                           ///< "GET"
  std::string path;                                             ///< of the address, decoded: "/state.json"
  std::vector<std::pair<std::string, std::string>> parameters;  ///< of the address, decoded, in its order
  std::string host;            ///< header Host; empty if missing, or if there are several
  std::string origin;          ///< header Origin; empty if missing
  std::string type;            ///< header Content-Type; empty if missing
  bool body_is_plain = false;  ///< whether the body has a stated length, and is not encoded
  std::string body;            ///< empty until it has been read

  /// Returns the first value of a parameter; empty if there is none.
  std::string parameter(std::string_view name) const;
};

/// The answer to a request.
struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain";
  std::string bytes;
};

/// Decodes the target of a request, such as "/layer.bin?name=key+light&token=1". `%` that two hexadecimal
/// digits do not follow stays as it is. Without a leading '/', the path is empty.
void read_target(std::string_view target, HttpRequest& request);

}  // namespace pelage
