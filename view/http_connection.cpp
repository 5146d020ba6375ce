// SPDX-License-Identifier: Apache-2.0
#include "view/http_connection.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <fmt/format.h>

namespace pelage {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

constexpr size_t kPiece = 64 << 10;        // bytes written at once
constexpr size_t kMaxDiscarded = 1 << 20;  // bytes
constexpr std::chrono::seconds kFarewell{1};

/// Of every answer.
constexpr const char* kHeaders =
    "Connection: close\r\n"
    "Cache-Control: no-store\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Content-Security-Policy: default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self'; "
    "img-src 'self' blob: data:; frame-ancestors 'none'\r\n";

std::string head_of(const HttpAnswer& answer) {
  const auto status = http::int_to_status(static_cast<unsigned>(answer.status));
  std::string head =
      fmt::format("HTTP/1.1 {} {}\r\n", answer.status, std::string(http::obsolete_reason(status)));
  if (status != http::status::no_content)
    head += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n", answer.type, answer.bytes.size());
  return head + kHeaders + "\r\n";
}

}  // namespace

HttpConnection::HttpConnection(asio::ip::tcp::socket socket, asio::ip::address address, HttpShared& shared)
    : shared_(shared),
      address_(std::move(address)),
      stream_(std::move(socket)),
      buffer_(shared.limits.head + shared.limits.body) {
  parser_.header_limit(static_cast<uint32_t>(shared.limits.head));
  // Until the request is accepted, its body is not read, and so not judged.
  parser_.body_limit(std::numeric_limits<uint64_t>::max());  // Boost 1.74 takes `none` for 0
}

void HttpConnection::run() {
  stream_.expires_after(shared_.limits.request);
  http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](ErrorCode failed, size_t) {
    self->head_is_read(failed);
  });
}

void HttpConnection::head_is_read(ErrorCode failed) {
  if (failed == http::error::header_limit || failed == http::error::buffer_overflow)
    return write({431, "text/plain", "the request is too large\n"});
  const bool is_malformed = failed.category() == make_error_code(http::error::bad_method).category() &&
                            failed != http::error::end_of_stream;
  if (is_malformed) return write({400, "text/plain", "the request is malformed\n"});
  if (failed) return;  // the client has left, or its time is over
  const auto& head = parser_.get();
  const auto header = [&](http::field name) { return std::string(head[name]); };
  request_.method = std::string(head.method_string());
  read_target({head.target().data(), head.target().size()}, request_);
  request_.host = head.count(http::field::host) == 1 ? header(http::field::host) : "";
  request_.origin = header(http::field::origin);
  request_.type = header(http::field::content_type);
  request_.body_is_plain =
      parser_.content_length() && !parser_.chunked() && head.count(http::field::content_encoding) == 0;
  if (std::optional<HttpAnswer> refusal = shared_.handler.refusal(request_))
    return write(*std::move(refusal));
  accept();
}

void HttpConnection::accept() {
  accepted_ = true;
  counted_.emplace(shared_.accepted);
  if (counted_->before >= shared_.limits.accepted)
    return write({503, "text/plain", "too many requests at once; ask again\n"});
  if (parser_.content_length().value_or(0) > shared_.limits.body)
    return write({413, "text/plain", "the body is too large\n"});
  parser_.body_limit(shared_.limits.body);
  http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](ErrorCode failed, size_t) {
    if (failed == http::error::body_limit) return self->write({413, "text/plain", "the body is too large\n"});
    if (!failed) self->answer();
  });
}

void HttpConnection::answer() {
  request_.body = std::move(parser_.get().body());
  asio::post(shared_.workers, [self = shared_from_this()]() mutable {
    HttpAnswer answer;
    try {
      answer = self->shared_.handler.answer(self->request_);
    } catch (const std::bad_alloc&) {
      answer = {503, "text/plain", "out of memory\n"};
    } catch (const std::exception& error) {
      answer = {500, "text/plain", error.what()};
    }
    const auto reader = self->stream_.get_executor();
    asio::post(reader, [self = std::move(self), answer = std::move(answer)]() mutable {
      self->write(std::move(answer));
    });
  });
}

void HttpConnection::write(HttpAnswer answer) {
  bytes_ = head_of(answer);
  if (request_.method != "HEAD") bytes_.insert(bytes_.size(), std::move(answer.bytes));
  write_piece(0);
}

void HttpConnection::write_piece(size_t at) {
  if (at == bytes_.size()) return wait_for_client();
  const size_t size = std::min(bytes_.size() - at, kPiece);
  stream_.expires_after(shared_.limits.piece);
  asio::async_write(stream_, asio::buffer(bytes_.data() + at, size),
                    [self = shared_from_this(), at, size](ErrorCode failed, size_t) {
                      if (!failed) self->write_piece(at + size);
                    });
}

/// Reads and discards what the client still sends. If the socket were closed before, the system would reset
/// the connection, and the client might lose the answer.
void HttpConnection::wait_for_client() {
  if (discarded_ == 0) {
    counted_.reset();
    ErrorCode failed;
    stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, failed);
    bytes_.assign(kPiece, '\0');
    stream_.expires_after(kFarewell);
  }
  stream_.async_read_some(asio::buffer(bytes_), [self = shared_from_this()](ErrorCode failed, size_t count) {
    self->discarded_ += count;
    if (!failed && self->discarded_ < kMaxDiscarded) self->wait_for_client();
  });
}

}  // namespace pelage
