// SPDX-License-Identifier: Apache-2.0
#include "view/http_server.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <string>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "view/http_connection.h"

namespace pelage {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr size_t kWorkers = 16;
constexpr std::chrono::milliseconds kPause{50};

}  // namespace

struct HttpServer::State {
  using Waiting = std::deque<std::weak_ptr<HttpConnection>>;

  void accept();
  void admit(tcp::socket socket);
  void close(Waiting::iterator old);
  void run();

  std::optional<HttpShared> shared;  // the first members: connections in `io` and `workers` use them
  Waiting waiting;                   // the oldest first
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer pause{io};
  asio::thread_pool workers{kWorkers};
  bool accepts = false;  // a connection will be accepted without another call of accept()
  std::thread thread;
};

void HttpServer::State::accept() {
  acceptor.async_accept([this](boost::system::error_code failed, tcp::socket socket) {
    if (failed) {
      // The process has no file descriptors left, for example. Without a pause, this would fail all the time.
      if (!waiting.empty()) close(waiting.begin());
      accepts = false;
      pause.expires_after(kPause);
      pause.async_wait([this](boost::system::error_code) { accept(); });
      accepts = true;
      return;
    }
    accepts = false;
    admit(std::move(socket));
    accept();
  });
  accepts = true;
}

void HttpServer::State::admit(tcp::socket socket) {
  std::erase_if(waiting, [](const std::weak_ptr<HttpConnection>& old) {
    const auto connection = old.lock();
    return !connection || !connection->is_waiting();
  });
  boost::system::error_code failed;
  const asio::ip::address address = socket.remote_endpoint(failed).address();
  if (failed) return;
  const auto is_neighbour = [&](const std::weak_ptr<HttpConnection>& old) {
    const auto connection = old.lock();
    return connection && connection->address() == address;
  };
  const auto of_address = static_cast<size_t>(std::count_if(waiting.begin(), waiting.end(), is_neighbour));
  if (of_address >= shared->limits.per_address) {
    close(std::find_if(waiting.begin(), waiting.end(), is_neighbour));
  } else if (waiting.size() >= shared->limits.waiting) {
    close(waiting.begin());
  }
  const auto connection = std::make_shared<HttpConnection>(std::move(socket), address, *shared);
  waiting.push_back(connection);
  connection->run();
}

void HttpServer::State::close(Waiting::iterator old) {
  if (const auto connection = old->lock()) connection->close();
  waiting.erase(old);
}

void HttpServer::State::run() {
  while (true) {
    try {
      if (!accepts) accept();
      io.run();
      return;
    } catch (const std::exception&) {
      // There is no memory for a connection, which is closed by now. All others continue.
    }
  }
}

HttpServer::HttpServer(const std::string& address, int port) : state_(std::make_unique<State>()) {
  boost::system::error_code failed;
  const auto found =
      tcp::resolver(state_->io).resolve(address, std::to_string(port), tcp::resolver::passive, failed);
  tcp::acceptor& acceptor = state_->acceptor;
  if (!failed) {
    const tcp::endpoint endpoint = *found.begin();
    acceptor.open(endpoint.protocol(), failed);
    if (!failed) acceptor.set_option(tcp::acceptor::reuse_address(true), failed);
    if (!failed) acceptor.bind(endpoint, failed);
    if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
  }
  if (failed) {
    throw Error(ErrorKind::kFailed,
                port == 0 ? fmt::format("--bind {}: this machine has no such address", address)
                          : fmt::format("--port {}: cannot be used at {}; another program may use it", port,
                                        address));
  }
}

HttpServer::~HttpServer() {
  if (!state_->thread.joinable()) return;
  state_->workers.stop();
  state_->workers.join();
  state_->io.stop();
  state_->thread.join();
}

int HttpServer::port() const { return state_->acceptor.local_endpoint().port(); }

void HttpServer::start(HttpHandler& handler, const HttpLimits& limits) {
  state_->shared.emplace(handler, limits, state_->workers);
  state_->thread = std::thread([this] { state_->run(); });
}

}  // namespace pelage
