// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_programs.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "rib/scene/rib_interpreter.h"
#include "rib/scene/rib_reading.h"
#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage {
namespace {

using namespace rib_test;

class RibProgramsTest : public testing::Test {
 protected:
  /// A shell script that answers each line of its input.
  void script(const std::string& name, const std::string& body) const {
    files_.write("#!/bin/sh\nwhile read -r detail arguments; do\n" + body + "\ndone\n", name);
    std::filesystem::permissions(path(name), std::filesystem::perms::owner_all);
  }
  std::filesystem::path path(const std::string& name) const { return files_.folder.path() / name; }
  RibScene read(const std::string& text, RibReadOptions options = {}) const {
    options.programs = programs_;
    return read_rib(files_.write(text, "a.rib"), options);
  }
  static std::string request(const std::string& command, const std::string& arguments = "x") {
    return "Procedural \"RunProgram\" [\"" + command + "\" \"" + arguments + "\"] [0 1 0 1 0 1]\n";
  }
  static size_t count(const RibScene& scene) {
    size_t strands = 0;
    for (const RibCoat& coat : scene.coats) strands += rib_procedural(coat)->counts().strands;
    return strands;
  }
  const Files files_;
  std::shared_ptr<RibPrograms> programs_ =
      std::make_shared<RibPrograms>(RibProgramLimits{20, 1 << 20, 1 << 20});
};

const std::string kLine =
    "echo 'Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 1 0] \"constantwidth\" 0.1'\n";
const std::string kEnd = "printf '\\377'";

TEST_F(RibProgramsTest, RepliesAreDeferredLikeArchives) {
  script("gen", kLine + kLine + kEnd);
  const RibScene scene = read("Translate 1 0 0 " + request("gen") + request("gen", "y"));
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.coats.size(), 1u);
  EXPECT_EQ(scene.coats[0].batches.size(), 0u);
  ASSERT_EQ(scene.coats[0].deferred.size(), 2u);
  const Strands strands = rib_procedural(scene.coats[0])->split()[0]->generate();
  EXPECT_EQ(strands.strand_count(), 2u);
  EXPECT_EQ(strands.point(0), V3f(1, 0, 0));
}

TEST_F(RibProgramsTest, AProcessAnswersEachRequestOnce) {
  const std::string log = path("log").string();
  script("gen", "echo \"$$ $arguments\" >> " + log + "\n" + kLine + kEnd);
  const std::string text = request("gen", "first") + request("gen", "second words") + request("gen", "first");
  RibReadOptions description;
  description.geometry = false;
  read(text, description);
  const RibScene scene = read(text);
  for (const auto& leaf : rib_procedural(scene.coats[0])->split()) leaf->generate();
  EXPECT_EQ(count(scene), 3u);
  const std::string lines = read_file(log);
  const std::string process = lines.substr(0, lines.find(' '));
  EXPECT_EQ(lines, process + " first\n" + process + " second words\n");
}

TEST_F(RibProgramsTest, AProgramOutlivesTheThreadThatAskedFirst) {
  const std::string log = path("log").string();
  script("gen", "echo $$ >> " + log + "\n" + kLine + kEnd);
  std::thread([&] { read(request("gen", "first")); }).join();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  read(request("gen", "second"));
  const std::string lines = read_file(log), process = lines.substr(0, lines.find('\n') + 1);
  EXPECT_EQ(lines, process + process);
}

TEST_F(RibProgramsTest, AllRequestsTogetherHaveALimit) {
  script("gen", kLine + kEnd);
  programs_ = std::make_shared<RibPrograms>(RibProgramLimits{20, 1 << 20, 1 << 20, 2});
  const auto ask = [&](const std::string& text) { programs_->ask("gen", {files_.folder.path()}, text, {}); };
  ask("a"), ask("b"), ask("b");
  const auto message_of = [&](const std::string& text) -> std::string {
    try {
      ask(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_of("c").find("were asked more than 2 times"), std::string::npos);
  programs_ = std::make_shared<RibPrograms>(RibProgramLimits{20, 1 << 20, 1 << 20, 100, 200});
  ask("a");
  ask("b");
  EXPECT_NE(message_of("c").find("all replies together have more than 200 bytes"), std::string::npos);
}

TEST_F(RibProgramsTest, RepliesMayAskPrograms) {
  // Each reply but the last has a strand and asks again.
  script("gen",
         kLine +
             "[ \"$arguments\" -gt 0 ] && echo \"Translate 1 0 0 Procedural \\\"RunProgram\\\" [\\\"gen\\\" "
             "\\\"$((arguments - 1))\\\"] [0 1 0 1 0 1]\"\n" +
             kEnd);
  const RibScene scene = read(request("gen", "5"));
  EXPECT_EQ(count(scene), 6u);
  float far = 0;
  for (const auto& leaf : rib_procedural(scene.coats[0])->split())
    far = std::max(far, leaf->generate().point(0).x);
  EXPECT_EQ(far, 5);
  script(
      "endless",
      "echo \"Procedural \\\"RunProgram\\\" [\\\"endless\\\" \\\"$((arguments + 1))\\\"] [0 1 0 1 0 1]\"\n" +
          kEnd);
  EXPECT_NE(error_of([&] { read(request("endless", "0")); }).find("more than 100 nested replies"),
            std::string::npos);
}

TEST_F(RibProgramsTest, DetailIsTheAreaInThePicture) {
  const std::string log = path("log").string();
  script("gen", "echo \"$detail\" >> " + log + "\n" + kEnd);
  // A square of size 1 at distance 10, 90 degrees over 200 pixels: 10 x 10 pixels at its front side.
  read("Format 400 200 1 Projection \"perspective\" \"fov\" 90 Translate 0 0 10 WorldBegin " +
       request("gen") + "WorldEnd");
  read(request("gen", "without a camera"));
  EXPECT_EQ(read_file(log), "100\n1e+38\n");
}

TEST_F(RibProgramsTest, FailuresAreOneLine) {
  const auto failure = [&](const std::string& command) {
    std::string message = error_of([&] { read(request(command)); });
    message.erase(0, std::min(message.find("a.rib"), message.size()));
    const std::string start = "a.rib:1:1: Procedural: program '" + command + "'";
    return message.starts_with(start) ? message.substr(start.size()) : message;
  };
  script("early", kLine + "exit 7");
  EXPECT_EQ(failure("early"), ": it ended with exit code 7 before it ended its reply with a byte 255");
  script("killed", "kill -9 $$");
  EXPECT_EQ(failure("killed"), ": it ended by signal 9 before it ended its reply with a byte 255");
  EXPECT_EQ(failure("nothing_like_it"),
            ": there is no program 'nothing_like_it' beside the file, on the search path, or on PATH");
  script("bad", "printf 'Color\\n  Translate 1\\n\\377'");
  EXPECT_EQ(failure("bad"), ", line 1 of its reply: Color: expected 3 numbers, got 0");
  script("much", "while true; do " + kLine + "done");
  EXPECT_EQ(failure("much"), ": its reply has more than 1048576 bytes");
  programs_ = std::make_shared<RibPrograms>(RibProgramLimits{0.2, 1 << 20, 1 << 20});
  script("slow", "sleep 100");
  EXPECT_EQ(failure("slow"), ": it did not end its reply within 0.2 seconds");
}

TEST_F(RibProgramsTest, AProgramThatFailedIsStartedAgain) {
  script("gen", "[ \"$arguments\" = bad ] && exit 1\n" + kLine + kEnd);
  EXPECT_NE(error_of([&] { read(request("gen", "bad")); }), "");
  EXPECT_EQ(count(read(request("gen", "good"))), 1u);
}

TEST_F(RibProgramsTest, ItStopsWhenTheJobIsStopped) {
  script("slow", "sleep 100");
  RibReadOptions options;
  int asked = 0;
  options.check_stop = [&] {
    if (++asked > 3) throw Error(ErrorKind::kStopped, "stopped");
  };
  EXPECT_EQ(error_of([&] { read(request("slow"), options); }), "another kind: stopped");
}

TEST_F(RibProgramsTest, RepliesDoNotOutliveTheirUse) {
  script("gen", kLine + kEnd);
  std::filesystem::path reply;
  {
    programs_ = std::make_shared<RibPrograms>();
    const auto one = programs_->ask("gen", {path("gen").parent_path()}, "1 x", {});
    reply = one->path();
    EXPECT_TRUE(std::filesystem::exists(reply));
    programs_.reset();
  }
  EXPECT_FALSE(std::filesystem::exists(reply));
}

}  // namespace
}  // namespace pelage
