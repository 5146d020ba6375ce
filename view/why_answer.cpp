// SPDX-License-Identifier: Apache-2.0
#include "view/why_answer.h"

#include <exception>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "why/why_json.h"

namespace pelage {
namespace {

class QuietProgress final : public Progress {
 public:
  explicit QuietProgress(const std::function<bool()>& must_end) : must_end_(must_end) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return must_end_(); }

 private:
  const std::function<bool()>& must_end_;
};

CommandAnswer refusal(int status, const std::string& why) {
  const nlohmann::json error{{"error", why}};
  return {status, error.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

}  // namespace

std::optional<CommandAnswer> why_answer(const ExplainedFrame& frame, int x, int y, const Workers& workers,
                                        MemoryLedger& ledger, const std::function<bool()>& must_end) {
  QuietProgress progress(must_end);
  try {
    return CommandAnswer{200, why_json(explain_pixel(frame, x, y, {workers, ledger, progress}))};
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kStopped) return {};
    return refusal(error.kind() == ErrorKind::kArguments ? 400 : 409, error.what());
  } catch (const std::exception& error) {
    return refusal(500, error.what());
  }
}

CommandAnswer no_picture_answer() { return refusal(409, "there is no picture that could be explained"); }

}  // namespace pelage
