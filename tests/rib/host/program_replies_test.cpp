// SPDX-License-Identifier: Apache-2.0
#include "rib/host/program_replies.h"

#include <deque>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/rib/syntax/rib_tokens.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

/// Asks a program for everything, as a renderer does.
struct Asking {
  ProgramReplies replies{"pelage procedural --x"};
  std::vector<std::string> errors;
  std::set<uint64_t> ids;
  int requests = 0;

  void ask(const std::string& first) {
    std::deque<std::string> waiting{first};
    while (!waiting.empty()) {
      RibText text;
      const std::string error = replies.reply(waiting.front(), text);
      waiting.pop_front();
      ++requests;
      if (!error.empty()) errors.push_back(error);
      ASSERT_FALSE(text.text().empty());
      EXPECT_EQ(text.text().find('\377'), text.text().size() - 1);
      const std::string rib = text.text().substr(0, text.text().size() - 1);
      if (!error.empty()) {
        EXPECT_EQ(rib, "");
      }
      for (const RibRequest& request : rib_requests(rib)) {
        if (request.name == "Procedural") {
          EXPECT_EQ(request.arguments[0].texts[0], "RunProgram");
          EXPECT_EQ(request.arguments[1].texts[0], "pelage procedural --x");
          EXPECT_EQ(request.arguments[2].numbers.size(), 6u);
          waiting.push_back("1234.5 " + request.arguments[1].texts[1]);
        } else if (request.name == "Curves") {
          for (const double id : request.parameter("uniform integer id").numbers)
            ids.insert(static_cast<uint64_t>(id));
        }
      }
    }
  }
};

TEST(ProgramReplies, NestedRequestsGiveAllStrands) {
  const FurryScene files;
  Asking asking;
  asking.ask("1e+38 " + files.scene() + " character=walker coat=coat frame=2\n");
  EXPECT_EQ(asking.errors, std::vector<std::string>{});
  EXPECT_EQ(asking.ids.size(), 900u);
  EXPECT_GT(asking.requests, 20);
}

TEST(ProgramReplies, MistakesGiveAnEmptyReplyAndOneLine) {
  const FurryScene files;
  Asking asking;
  asking.ask("much " + files.scene());
  asking.ask("");
  asking.ask("5");
  asking.ask("5 /nowhere.yaml");
  EXPECT_EQ(asking.errors.size(), 4u);
  EXPECT_TRUE(asking.ids.empty());
  asking.ask("1e99 " + files.scene() + " character=post");  // and goes on
  EXPECT_EQ(asking.ids.size(), 30u);
}

TEST(ProgramReplies, LongRequestsAreNeitherHeldNorRepeated) {
  std::istringstream input("1 short\n" + std::string(3 * kMaxProgramRequest, 'x') + "\n2 last");
  std::string request;
  ASSERT_TRUE(read_program_request(input, request));
  EXPECT_EQ(request, "1 short");
  ASSERT_TRUE(read_program_request(input, request));
  EXPECT_EQ(request.size(), kMaxProgramRequest + 1);
  EXPECT_LT(request.capacity(), 3 * kMaxProgramRequest);
  RibText text;
  EXPECT_EQ(ProgramReplies("p").reply(request, text), "procedural: a request has more than 1 MiB");
  ASSERT_TRUE(read_program_request(input, request));
  EXPECT_EQ(request, "2 last");
  EXPECT_FALSE(read_program_request(input, request));
  const std::string most(kMaxProgramRequest - 3, 'y');
  for (const std::string& long_one : {most, "1 " + most, "1 s camera=" + most.substr(9)})
    EXPECT_LT(ProgramReplies("p").reply(long_one, text).size(), 1100u);
}

TEST(OneLine, StatesTheFirstOfManyProblems) {
  const Error error(ErrorKind::kInput, {{{"a", 1, 2}, "one\r"}, {{"b", 3, 4}, "two"}});
  EXPECT_EQ(one_line(error), "a:1:2: one  (and 1 more)");
  EXPECT_EQ(one_line(std::bad_alloc()), "out of memory");
}

}  // namespace
}  // namespace pelage
