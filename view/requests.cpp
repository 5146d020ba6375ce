// SPDX-License-Identifier: Apache-2.0
#include "view/requests.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <sys/random.h>

#include "base/error.h"

namespace pelage {
namespace {

/// Compares in a time that does not depend on where the texts differ.
bool equal_secrets(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(a[i] ^ b[i]) & 0xff;
  return difference == 0;
}

bool is_wildcard(std::string_view address) { return address == "0.0.0.0" || address == "::"; }

/// Whether a host is a number such as 192.168.0.7 or [fe80::1]. Nobody can point a number at another machine.
bool is_number(std::string_view host) {
  return !host.empty() && host.find_first_not_of(host[0] == '[' ? "[]:.0123456789abcdefABCDEF"
                                                                : ".0123456789") == std::string_view::npos;
}

}  // namespace

RequestRules::RequestRules(std::string address, int port, std::string token)
    : address_(std::move(address)), port_(fmt::format("{}", port)), token_(std::move(token)) {}

bool RequestRules::is_own_host(std::string_view host) const {
  const size_t colon = host.rfind(':');
  if (colon == std::string_view::npos || host.substr(colon + 1) != port_) return false;
  const std::string_view name = host.substr(0, colon);
  if (name == address_ || name == "[" + address_ + "]") return true;
  if (is_wildcard(address_)) return name == "localhost" || is_number(name);
  return address_ == "127.0.0.1" && name == "localhost";
}

int RequestRules::status(const RequestHead& head) const {
  if (!is_own_host(head.host)) return 403;
  if (!head.origin.empty() && head.origin != "http://" + head.host) return 403;
  if (!equal_secrets(head.token, token_)) return 403;
  if (head.method == "POST") {
    if (head.type.substr(0, head.type.find(';')) != "application/json") return 415;
    return head.body_is_plain ? 200 : 411;
  }
  return head.method == "GET" || head.method == "HEAD" ? 200 : 405;
}

std::string random_token() {
  unsigned char bytes[16];
  if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes)
    throw Error(ErrorKind::kFailed, "the system has no random numbers for the address");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

}  // namespace pelage
