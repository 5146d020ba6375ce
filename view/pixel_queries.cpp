// SPDX-License-Identifier: Apache-2.0
#include "view/pixel_queries.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace pelage {
namespace {

constexpr size_t kMaxQuestions = 8;  // the server has more threads
constexpr std::chrono::milliseconds kWhyPoll{20};
constexpr std::chrono::seconds kPatience{60};

CommandAnswer busy_reply(const char* why) { return {503, std::string("{\"error\": \"") + why + "\"}"}; }

}  // namespace

CommandAnswer PixelQueries::ask(int x, int y, const std::function<bool()>& gives_up) {
  const auto question = std::make_shared<Question>(Question{x, y, {}});
  {
    const std::lock_guard lock(mutex_);
    if (questions_.size() >= kMaxQuestions) return busy_reply("too many questions at once; ask again");
    questions_.push_back(question);
    ++count_;
  }
  {
    const std::lock_guard lock(asked_mutex_);
    if (asked_) asked_();
  }
  const auto end = std::chrono::steady_clock::now() + kPatience;
  std::unique_lock lock(mutex_);
  while (!answered_.wait_for(lock, kWhyPoll, [&] { return question->answer.has_value(); })) {
    if (!gives_up() && std::chrono::steady_clock::now() < end) continue;
    std::erase(questions_, question);
    return busy_reply("no answer in time; ask again when the picture is there");
  }
  return *question->answer;
}

bool PixelQueries::is_waiting() const {
  const std::lock_guard lock(mutex_);
  return !questions_.empty();
}

void PixelQueries::answer(const std::function<std::optional<CommandAnswer>(int x, int y)>& explain) {
  while (true) {
    std::shared_ptr<Question> question;
    {
      const std::lock_guard lock(mutex_);
      if (questions_.empty()) return;
      question = questions_.front();
    }
    std::optional<CommandAnswer> answer = explain(question->x, question->y);
    if (!answer) return;
    {
      const std::lock_guard lock(mutex_);
      question->answer = std::move(answer);
      std::erase(questions_, question);  // unless the client has given up
    }
    answered_.notify_all();
  }
}

void PixelQueries::on_ask(std::function<void()> asked) {
  const std::lock_guard lock(asked_mutex_);
  asked_ = std::move(asked);
}

}  // namespace pelage
