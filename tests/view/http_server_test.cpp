// SPDX-License-Identifier: Apache-2.0
#include "view/http_server.h"

#include <atomic>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/view/http_client.h"

namespace pelage::http_server_test {
namespace {

/// Accepts requests with the token "t".
class Handler final : public HttpHandler {
 public:
  std::optional<HttpAnswer> refusal(const HttpRequest& head) const override {
    if (head.parameter("token") != "t") return HttpAnswer{403, "text/plain", "no"};
    return {};
  }
  HttpAnswer answer(const HttpRequest& request) override {
    if (request.path == "/memory") throw std::bad_alloc();
    if (request.path == "/fault") throw std::runtime_error("a fault");
    if (request.path == "/wait") {
      ++waiting;
      while (!ends) std::this_thread::yield();
    }
    // More than the system stores for a client that does not read.
    if (request.path == "/huge") return {200, "application/octet-stream", std::string(24 << 20, 'x')};
    if (request.path == "/large") return {200, "application/octet-stream", std::string(3 << 20, 'x')};
    return {200, "text/plain", request.method + request.path + request.body};
  }
  std::atomic<int> waiting{0};
  std::atomic<bool> ends{false};
};

class HttpServerTest : public testing::Test {
 protected:
  void start(const HttpLimits& limits = {}) {
    server_ = std::make_unique<HttpServer>("127.0.0.1", 0);
    server_->start(handler_, limits);
  }
  int port() const { return server_->port(); }
  std::string answer(const std::string& request) const { return http_answer(port(), request); }
  int status(const std::string& request) const { return http_status(answer(request)); }

  Handler handler_;
  std::unique_ptr<HttpServer> server_;  // before the handler ends
};

const std::string kGood = "GET /a?token=t HTTP/1.1\r\nHost: x\r\n\r\n";

std::string post(const std::string& headers, const std::string& body) {
  return "POST /b?token=t HTTP/1.1\r\n" + headers + "\r\n" + body;
}

TEST_F(HttpServerTest, AnswersAreWholeWhateverRangeIsAskedFor) {
  start();
  const std::string head = "/large?token=t HTTP/1.1\r\n";
  for (const char* range :
       {"", "Range: bytes=0-5\r\n", "Range: bytes=0-90000\r\n", "Range: bytes=-7\r\n",
        "Range: bytes=5-1, 3-9999999999999999999\r\n", "If-Range: x\r\nRange: bytes=1-\r\n"}) {
    const std::string got = answer("GET " + head + range + "\r\n");
    EXPECT_EQ(http_status(got), 200) << range;
    EXPECT_EQ(http_body(got).size(), size_t{3 << 20}) << range;
    EXPECT_EQ(http_body(answer("GET /a?token=t HTTP/1.1\r\n" + std::string(range) + "\r\n")), "GET/a")
        << range;
  }
  const std::string got = answer("HEAD " + head + "\r\n");
  EXPECT_NE(got.find("Content-Length: 3145728\r\n"), std::string::npos) << got;
  EXPECT_EQ(http_body(got), "");
}

TEST_F(HttpServerTest, ARequestIsReadUpToItsLimits) {
  start();
  const std::string much(1 << 20, 'a');
  EXPECT_EQ(status("GET /" + much), 431);
  EXPECT_EQ(status("GET /a?token=t HTTP/1.1\r\nX: " + much), 431);
  EXPECT_EQ(status(much), 431);
  std::string lines = "GET /a?token=t HTTP/1.1\r\n";
  for (int i = 0; i < 10'000; ++i) lines += "X" + std::to_string(i) + ": 1\r\n";
  EXPECT_EQ(status(lines), 431);
  EXPECT_EQ(http_body(answer(post("Content-Length: 10000\r\n", std::string(10'000, 'c')))).size(), 10'006u);
  EXPECT_EQ(status(post("Content-Length: 10001\r\n", std::string(10'001, 'c'))), 413);
  EXPECT_EQ(status(post("Content-Length: 99999999999\r\n", much)), 413);
  EXPECT_EQ(status(post("Transfer-Encoding: chunked\r\n", "fffff\r\n" + much)), 413);
  for (const char* headers : {"Content-Length: -1\r\n", "Content-Length: 1e3\r\n", ": 1\r\n", "\x01: 1\r\n",
                              "Content-Length: 3\r\nContent-Length: 4\r\n"})
    EXPECT_EQ(status(post(headers, "ab")), 400) << headers;
  // Without a token, the body is not read.
  EXPECT_EQ(status("POST /b HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n" + much), 403);
  EXPECT_EQ(status(kGood), 200);
}

TEST_F(HttpServerTest, FaultsAreAnswered) {
  start();
  EXPECT_EQ(status("GET /memory?token=t HTTP/1.1\r\n\r\n"), 503);
  EXPECT_EQ(http_body(answer("GET /fault?token=t HTTP/1.1\r\n\r\n")), "a fault");
  EXPECT_EQ(status(kGood), 200);
}

TEST_F(HttpServerTest, ConnectionsWithoutATokenDoNotKeepOthersOut) {
  HttpLimits limits;
  limits.request = std::chrono::minutes(10);
  limits.per_address = 20;
  start(limits);
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 300; ++i) {
    idle.push_back(std::make_unique<HttpClient>(port()));
    if (i % 2) idle.back()->send(kGood.substr(0, static_cast<size_t>(i) % kGood.size()));
    if (i % 50 == 0) {
      EXPECT_EQ(status(kGood), 200);
    }
  }
  // The last ones are still open, and the first ones are closed.
  idle.back()->send(kGood.substr(299 % kGood.size()));
  EXPECT_EQ(http_status(idle.back()->finish()), 200);
  EXPECT_EQ(idle.front()->receive(), "");
}

TEST_F(HttpServerTest, ASlowRequestEnds) {
  HttpLimits limits;
  limits.request = std::chrono::milliseconds(50);
  start(limits);
  for (const std::string& part : {std::string(), kGood.substr(0, 20), post("Content-Length: 9\r\n", "abc")}) {
    const HttpClient client(port());
    client.send(part);
    EXPECT_EQ(client.receive(), "");  // not before the server closes the connection
  }
  limits = {};
  limits.piece = std::chrono::milliseconds(50);
  start(limits);
  // On a busy machine, the server may find out late that nobody reads.
  size_t received = 24 << 20;
  for (auto unread = std::chrono::milliseconds(200); received == 24 << 20; unread *= 4) {
    ASSERT_LT(unread, std::chrono::minutes(1));
    const HttpClient client(port());
    client.send("GET /huge?token=t HTTP/1.1\r\n\r\n");
    std::this_thread::sleep_for(unread);
    received = http_body(client.receive()).size();
  }
}

TEST_F(HttpServerTest, TooManyAcceptedRequestsAreRefused) {
  HttpLimits limits;
  limits.accepted = 3;
  start(limits);
  std::vector<std::unique_ptr<HttpClient>> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(std::make_unique<HttpClient>(port()));
    clients.back()->send("GET /wait?token=t HTTP/1.1\r\n\r\n");
  }
  while (handler_.waiting < 3) std::this_thread::yield();
  EXPECT_EQ(status(kGood), 503);
  handler_.ends = true;
  for (const auto& client : clients) EXPECT_EQ(http_status(client->finish()), 200);
  EXPECT_EQ(status(kGood), 200);
}

TEST_F(HttpServerTest, EndsWithOpenConnectionsAndAPortInUseIsRefused) {
  start();
  const HttpClient idle(port()), half(port()), reader(port());
  half.send("GET /");
  reader.send("GET /large?token=t HTTP/1.1\r\n\r\n");
  try {
    const HttpServer other("127.0.0.1", port());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    EXPECT_NE(std::string(error.what()).find("another program may use it"), std::string::npos);
  }
  server_ = nullptr;
  EXPECT_EQ(idle.receive() + half.receive(), "");
}

}  // namespace
}  // namespace pelage::http_server_test
