// SPDX-License-Identifier: Apache-2.0
#include "view/pixel_queries.h"

#include <atomic>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace pelage {
namespace {

bool never() { return false; }

CommandAnswer text_of(int x, int y) { return {200, std::to_string(x) + " " + std::to_string(y)}; }

TEST(PixelQueries, EveryClientGetsItsAnswer) {
  PixelQueries state;
  std::atomic<bool> ends{false};
  std::thread renderer([&] {
    while (!ends) state.answer(text_of);
  });
  std::vector<std::thread> clients;
  for (int i = 0; i < 6; ++i) {
    clients.emplace_back([&state, i] {
      for (int k = 0; k < 50; ++k) EXPECT_EQ(state.ask(i, k, never).json, text_of(i, k).json);
    });
  }
  for (std::thread& client : clients) client.join();
  ends = true;
  renderer.join();
  EXPECT_FALSE(state.is_waiting());
}

TEST(PixelQueries, AQuestionStaysUntilItHasAnAnswer) {
  PixelQueries state;
  std::atomic<int> asked{0};
  state.on_ask([&] { ++asked; });
  CommandAnswer answer;
  std::thread client([&] { answer = state.ask(3, 4, never); });
  while (!state.is_waiting()) std::this_thread::yield();
  state.answer([](int, int) { return std::optional<CommandAnswer>(); });
  EXPECT_TRUE(state.is_waiting());
  state.answer(text_of);
  client.join();
  EXPECT_EQ(answer.json, "3 4");
  EXPECT_EQ(asked, 1);
  state.on_ask({});
}

TEST(PixelQueries, ClientsGiveUpAndMayNotBeTooMany) {
  PixelQueries state;
  std::atomic<bool> closing{false};
  std::atomic<int> refused{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 12; ++i) {
    clients.emplace_back([&] {
      if (state.ask(1, 2, [&] { return closing.load(); }).status == 503) ++refused;
    });
  }
  while (refused < 4) std::this_thread::yield();  // 8 wait
  closing = true;
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(refused, 12);
  EXPECT_FALSE(state.is_waiting());
}

}  // namespace
}  // namespace pelage
