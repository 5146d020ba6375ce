// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "view/command_answer.h"

namespace pelage {

/// Passes the questions of clients ("explain pixel x, y") to the thread that renders, and its answers back.
/// Thread safety: all members may be called from any thread.
class PixelQueries {
 public:
  /// Asks for an explanation of pixel (x, y), and waits for it. Returns a refusal if other clients wait
  /// for too many answers, if the answer takes too long, or once `gives_up` returns true, which is called
  /// every few milliseconds.
  CommandAnswer ask(int x, int y, const std::function<bool()>& gives_up);

  /// Returns whether a question has no answer yet.
  bool is_waiting() const;
  /// Returns how many questions have been asked.
  uint32_t asked() const { return count_; }
  /// Answers all questions with `explain(x, y)`. Once it returns nothing, the rest is left for the next call.
  void answer(const std::function<std::optional<CommandAnswer>(int x, int y)>& explain);
  /// Calls `asked` after each question. An empty function ends these calls.
  void on_ask(std::function<void()> asked);

 private:
  struct Question {
    int x, y;
    std::optional<CommandAnswer> answer;
  };

  mutable std::mutex mutex_;  // guards questions_ and their members
  std::condition_variable answered_;
  std::vector<std::shared_ptr<Question>> questions_;  // without an answer
  std::atomic<uint32_t> count_{0};
  std::mutex asked_mutex_;  // guards asked_; locked while it is called
  std::function<void()> asked_;
};

}  // namespace pelage
