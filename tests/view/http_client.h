// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace pelage {

/// A client of a server on this machine, which sends any bytes.
class HttpClient {
 public:
  explicit HttpClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~HttpClient() { ::close(socket_); }
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// Sends as much as the server takes. Returns false if it has closed the connection.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0) return false;
      bytes.remove_prefix(static_cast<size_t>(sent));
    }
    return true;
  }
  /// Sends no more, and returns all bytes of the answer.
  std::string finish() const {
    ::shutdown(socket_, SHUT_WR);
    return receive();
  }
  /// Returns all bytes until the server closes the connection.
  std::string receive() const {
    std::string bytes(1 << 16, '\0'), all;
    for (ssize_t size = 0; (size = ::recv(socket_, bytes.data(), bytes.size(), 0)) > 0;)
      all.append(bytes, 0, static_cast<size_t>(size));
    return all;
  }

 private:
  const int socket_;
};

inline std::string http_answer(int port, std::string_view request) {
  const HttpClient client(port);
  client.send(request);
  return client.finish();
}

/// Returns the status code of an answer; 0 if there is none.
inline int http_status(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
}

/// Returns the bytes after the head of an answer.
inline std::string http_body(const std::string& answer) {
  const size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? "" : answer.substr(end + 4);
}

}  // namespace pelage
