// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "view/http_server.h"

namespace pelage {

/// What all connections of a server share.
struct HttpShared {
  HttpShared(HttpHandler& of_server, const HttpLimits& granted, boost::asio::thread_pool& pool)
      : handler(of_server), limits(granted), workers(pool) {}

  HttpHandler& handler;
  const HttpLimits limits;
  boost::asio::thread_pool& workers;  ///< they call HttpHandler::answer()
  std::atomic<int> accepted{0};       ///< count of accepted requests whose answer is not written
};

/// A connection of a client. It keeps itself alive until its answer is written, its time is over or the
/// client has left. All members are called on the thread that reads and writes.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(boost::asio::ip::tcp::socket socket, boost::asio::ip::address address, HttpShared& shared);

  /// Begins to read.
  void run();
  void close() { stream_.close(); }
  /// Returns whether the request has not been accepted.
  bool is_waiting() const { return !accepted_; }
  const boost::asio::ip::address& address() const { return address_; }

 private:
  using ErrorCode = boost::beast::error_code;

  /// Counts an accepted request until its answer is written.
  struct Accepted {
    explicit Accepted(std::atomic<int>& all) : count(all), before(all++) {}
    ~Accepted() { --count; }
    Accepted(const Accepted&) = delete;
    Accepted& operator=(const Accepted&) = delete;
    std::atomic<int>& count;
    const int before;
  };

  void head_is_read(ErrorCode failed);
  void accept();
  void answer();
  void write(HttpAnswer answer);
  void write_piece(size_t at);
  void wait_for_client();

  HttpShared& shared_;
  const boost::asio::ip::address address_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::string_body> parser_;
  HttpRequest request_;
  bool accepted_ = false;
  std::optional<Accepted> counted_;
  std::string bytes_;     // of the answer, with its head
  size_t discarded_ = 0;  // bytes that the client has sent since
};

}  // namespace pelage
