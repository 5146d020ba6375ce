// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "view/http_request.h"

namespace pelage {

/// Decides what a server answers.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;
  /// Returns the refusal of a request whose body has not been read; empty to accept the request. Called on
  /// the one thread that reads and writes, so it must be quick.
  virtual std::optional<HttpAnswer> refusal(const HttpRequest& head) const = 0;
  /// Answers an accepted request. Called by several threads. An exception becomes an answer: status 503 for
  /// std::bad_alloc, otherwise 500.
  virtual HttpAnswer answer(const HttpRequest& request) = 0;
};

/// What a server grants to its clients. A connection is *waiting* until the handler accepts its request.
struct HttpLimits {
  size_t head = 16 << 10;   ///< bytes of the first line and the headers of a request
  size_t body = 10'000;     ///< bytes
  size_t waiting = 128;     ///< max count of waiting connections; for another one, the oldest is closed
  size_t per_address = 32;  ///< the same for those of one address
  int accepted = 64;        ///< max count of accepted requests at once
  std::chrono::milliseconds request{5000};  ///< max time from the connection to the end of its request
  std::chrono::milliseconds piece{10000};   ///< max time in which a client reads the next 64 KiB
};

/// A server for HTTP/1.1 with one request per connection. It always answers with all bytes, also to a request
/// for a range of them. One thread reads requests and writes answers, and other threads compute these. So
/// connections that wait occupy no thread, and cannot keep accepted requests from being answered.
class HttpServer {
 public:
  /// Binds an address. `port`: 0 chooses a free one. Throws Error (kFailed) when the address or the port
  /// cannot be used.
  HttpServer(const std::string& address, int port);
  /// Closes all connections. Waits for answer() in the threads that call it.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  /// Begins to answer; call once. The handler must outlive the server.
  void start(HttpHandler& handler, const HttpLimits& limits = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pelage
