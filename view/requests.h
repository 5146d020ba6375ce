// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// The parts of a request that decide whether it is answered.
struct RequestHead {
  std::string method;          ///< "GET"
  std::string host;            ///< header Host; empty if missing
  std::string origin;          ///< header Origin; empty if missing
  std::string token;           ///< parameter `token` of the query; empty if missing
  std::string type = {};       ///< header Content-Type; empty if missing
  bool body_is_plain = false;  ///< whether the body has a stated length, and is not encoded
};

/// Decides which requests the server answers. Only pages of this server may send requests from a browser: a
/// page of another site has another Origin, and a name that an attacker points at this machine is another
/// Host.
class RequestRules {
 public:
  /// `address`: the address that the server is bound to. `token`: the secret of this server.
  RequestRules(std::string address, int port, std::string token);

  const std::string& token() const { return token_; }
  /// Returns the status code of the refusal, or 200 if the request is to be answered: 405 for other methods
  /// than GET, HEAD and POST, 403 for a foreign Host or Origin, and for a wrong or missing token. The body of
  /// POST must be of the type application/json (415), and plain (411).
  int status(const RequestHead& head) const;

 private:
  bool is_own_host(std::string_view host) const;

  std::string address_, port_, token_;
};

/// Returns 32 random hexadecimal digits from the system's generator. Throws Error (kFailed).
std::string random_token();

}  // namespace pelage
