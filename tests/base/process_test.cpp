// SPDX-License-Identifier: Apache-2.0
#include "base/process.h"

#include <chrono>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

ProcessSetup shell(const std::string& script) { return {{"/bin/sh", "-c", script}}; }

ProcessSetup piped(const std::string& script) { return {{"/bin/sh", "-c", script}, ProcessStream::kPiped}; }

std::string error_of(const ProcessSetup& setup) {
  try {
    Process process(setup);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    return error.what();
  }
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Waits until the process of this number has ended, which its parent may not have noticed.
bool is_gone(pid_t id) {
  for (int i = 0; i < 500; ++i) {
    std::ifstream status("/proc/" + std::to_string(id) + "/stat");
    std::string number, name, state;
    if (!(status >> number >> name >> state) || state == "Z") return true;
    ::usleep(10'000);
  }
  return false;
}

/// Sends all of `input` and returns all of the output.
std::string answer(Process& process, std::string_view input) {
  std::string output, errors;
  while (!input.empty()) process.exchange(input, output, errors, 1);
  while (process.exchange(input, output, errors, 1) && output.find('\n') == std::string::npos) {
  }
  return output;
}

TEST(ProcessTest, TellsHowTheProgramEnded) {
  const ProcessResult good = run_process(shell("echo out; echo err >&2"));
  EXPECT_TRUE(good.end.succeeded());
  EXPECT_EQ(good.output, "out\n");
  EXPECT_EQ(good.errors, "err\n");
  EXPECT_GT(good.end.peak_rss_bytes, 1 << 16);
  EXPECT_EQ(run_process(shell("exit 3")).end.exit_code, 3);
  const ProcessEnd killed = run_process(shell("kill -9 $$")).end;
  EXPECT_EQ(killed.signal, SIGKILL);
  EXPECT_FALSE(killed.succeeded());
}

TEST(ProcessTest, CountsTimeOfTheProgramAndItsChildren) {
  const ProcessEnd end =
      run_process(shell("i=0; while [ $i -lt 100000 ]; do i=$((i + 1)); done; sleep 0.2")).end;
  EXPECT_GT(end.cpu_s, 0.01);
  EXPECT_GT(end.wall_s, end.cpu_s + 0.1);
}

TEST(ProcessTest, OutputAndErrorsShareALog) {
  const TemporaryFolder folder;
  ProcessSetup setup = shell("echo out; echo err >&2");
  setup.log = folder.path() / "log";
  const ProcessResult result = run_process(setup);
  EXPECT_EQ(result.output + result.errors, "");
  EXPECT_EQ(read_file(setup.log), "out\nerr\n");
  setup.log = folder.path() / "none" / "log";
  EXPECT_NE(error_of(setup).find("none/log: cannot be written: No such file"), std::string::npos);
}

TEST(ProcessTest, WhatCannotBeStartedIsAnError) {
  EXPECT_EQ(error_of({{"/no/such/program"}}), "/no/such/program cannot be run: No such file or directory");
  EXPECT_EQ(error_of({{"/dev/null"}}), "/dev/null cannot be run: Permission denied");
  EXPECT_EQ(error_of({{"/"}}), "/ cannot be run: Permission denied");
}

TEST(ProcessTest, AnswersWhatItIsSent) {
  Process process(piped("while read -r line; do echo \"got $line\"; done; exit 5"));
  EXPECT_EQ(answer(process, "one\n"), "got one\n");
  EXPECT_EQ(answer(process, "two\n"), "got two\n");
  EXPECT_FALSE(process.wait(0));
  process.close_pipes();
  EXPECT_EQ(process.wait(kNoLimit_s)->exit_code, 5);
}

TEST(ProcessTest, MuchInputAndOutputDoNotWaitForEachOther) {
  Process process(piped("cat"));
  const std::string sent(3 << 20, 'x');
  std::string_view left = sent;
  std::string output, errors;
  while (output.size() < sent.size()) ASSERT_TRUE(process.exchange(left, output, errors, 10));
  EXPECT_EQ(output, sent);
}

TEST(ProcessTest, InputThatNobodyReadsIsDropped) {
  Process process(piped("exec <&-; echo closed; sleep 1000"));
  EXPECT_EQ(answer(process, ""), "closed\n");
  const std::string sent(1 << 20, 'x');
  std::string_view left = sent;
  std::string output, errors;
  EXPECT_TRUE(process.exchange(left, output, errors, 10));  // and no SIGPIPE
  EXPECT_TRUE(left.empty());
  Process deaf(piped("sleep 1000"));
  left = sent;
  for (int i = 0; i < 20; ++i) deaf.exchange(left, output, errors, 0.001);
  EXPECT_FALSE(left.empty()) << "the rest is for later";
}

TEST(ProcessTest, HasNoInputUnlessItIsPiped) {
  EXPECT_EQ(run_process(shell("cat; echo end")).output, "end\n");
}

TEST(ProcessTest, ChangesVariablesOfTheEnvironment) {
  ::setenv("PELAGE_TEST_KEPT", "kept", 1);
  ::setenv("PELAGE_TEST_CHANGED", "before", 1);
  ::setenv("PELAGE_TEST_REMOVED", "there", 1);
  ProcessSetup setup =
      shell("echo $PELAGE_TEST_KEPT ${PELAGE_TEST_CHANGED} ${PELAGE_TEST_REMOVED-gone} \"$PELAGE_TEST_NEW\"");
  setup.environment = {"PELAGE_TEST_CHANGED=after", "PELAGE_TEST_REMOVED", "PELAGE_TEST_NEW=a=b c"};
  EXPECT_EQ(run_process(setup).output, "kept after gone a=b c\n");
  EXPECT_EQ(run_process(shell("echo $PELAGE_TEST_CHANGED")).output, "before\n");
  setup.environment = {"PELAGE_TEST_*", "PELAGE_TEST_NEW=*"};
  EXPECT_EQ(run_process(setup).output, "gone *\n");
}

TEST(ProcessTest, IsStoppedAtItsTimeLimit) {
  ProcessLimits limits;
  limits.seconds = 0.05;
  const ProcessEnd end = run_process(shell("exec sleep 1000"), limits).end;
  EXPECT_TRUE(end.timed_out);
  EXPECT_FALSE(end.interrupted || end.output_exceeded || end.succeeded());
  EXPECT_EQ(end.signal, SIGTERM);
}

TEST(ProcessTest, IsStoppedWhenItIsCancelled) {
  ProcessLimits limits;
  limits.cancelled = [] { return true; };
  const ProcessEnd end = run_process(shell("exec sleep 1000"), limits).end;
  EXPECT_TRUE(end.interrupted);
  EXPECT_FALSE(end.timed_out || end.succeeded());
}

TEST(ProcessTest, IsKilledIfItIgnoresTheRequest) {
  const TemporaryFolder folder;
  const auto ready = folder.path() / "ready";
  ProcessLimits limits;
  limits.kill_delay_s = 0.05;
  limits.cancelled = [&] { return std::filesystem::exists(ready); };
  const std::string script = "trap '' TERM; touch " + ready.string() + "; while :; do sleep 0.05; done";
  const ProcessEnd end = run_process(shell(script), limits).end;
  EXPECT_TRUE(end.interrupted);
  EXPECT_EQ(end.signal, SIGKILL);
}

TEST(ProcessTest, OutputWithoutEndIsStopped) {
  ProcessLimits limits;
  limits.output_bytes = 100'000;
  ProcessResult result = run_process(shell("exec yes"), limits);
  EXPECT_TRUE(result.end.output_exceeded);
  EXPECT_FALSE(result.end.succeeded());
  EXPECT_EQ(result.output.size(), limits.output_bytes);
  result = run_process(shell("yes >&2 & exec yes"), limits);
  EXPECT_TRUE(result.end.output_exceeded);
  EXPECT_EQ(result.output.size() + result.errors.size(), limits.output_bytes);
}

TEST(ProcessTest, WhatTheProgramLeavesBehindIsNotWaitedFor) {
  ProcessResult result;
  EXPECT_LT(seconds_of([&] { result = run_process(shell("sleep 1000 & echo $!")); }), 100);
  EXPECT_TRUE(result.end.succeeded());
  const pid_t left = std::stoi(result.output);
  EXPECT_EQ(::kill(left, 0), 0);
  ::kill(left, SIGKILL);
}

TEST(ProcessTest, SignalsReachTheGroup) {
  Process process(piped("sleep 1000 & echo $!; wait"));
  const pid_t child = std::stoi(answer(process, ""));
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(kNoLimit_s)->signal, SIGTERM);
  EXPECT_TRUE(is_gone(child));
  process.signal(SIGKILL);  // to nobody
}

TEST(ProcessTest, EndsWithTheObject) {
  pid_t id = 0;
  {
    Process process(piped("trap '' TERM; echo $$; while :; do sleep 0.05; done"));
    id = std::stoi(answer(process, ""));
  }
  EXPECT_TRUE(is_gone(id));
}

TEST(ProcessTest, OutlivesTheThreadThatStartedIt) {
  std::optional<Process> process;
  std::thread([&] { process.emplace(piped("while read -r line; do echo $line; done")); }).join();
  EXPECT_FALSE(process->wait(0.05));
  EXPECT_EQ(answer(*process, "there\n"), "there\n");
}

/// Ends when the whole program dies, whatever killed it.
TEST(ProcessTest, EndsWithThisProgram) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ProcessSetup setup = piped("trap '' TERM HUP; echo $$; while :; do sleep 0.05; done");
  const pid_t host = ::fork();
  if (host == 0) {
    Process process(setup);
    const std::string id = answer(process, "");
    [[maybe_unused]] const ssize_t written = ::write(ends[1], id.data(), id.size());
    ::kill(::getpid(), SIGKILL);
  }
  char id[32] = {};
  EXPECT_GT(::read(ends[0], id, sizeof id - 1), 0);
  EXPECT_TRUE(is_gone(std::stoi(id)));
  EXPECT_TRUE(is_gone(host));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(ProcessTest, ReceivesSignalsThatThisThreadBlocks) {
  sigset_t term, before;
  sigemptyset(&term);
  sigaddset(&term, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &term, &before);
  EXPECT_EQ(run_process(shell("kill -TERM $$; echo no")).end.signal, SIGTERM);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST(ProcessTest, SignalsArriveAgainWhenItsThreadCannotStart) {
  pthread_attr_t usual, huge;
  ASSERT_EQ(::pthread_getattr_default_np(&usual), 0);
  ASSERT_EQ(::pthread_attr_init(&huge), 0);
  ASSERT_EQ(::pthread_attr_setstacksize(&huge, size_t(1) << 47), 0);  // all addresses of a process
  ASSERT_EQ(::pthread_setattr_default_np(&huge), 0);
  EXPECT_NE(error_of({{"/bin/true"}}).find("cannot start a thread"), std::string::npos);
  EXPECT_EQ(::pthread_setattr_default_np(&usual), 0);
  sigset_t blocked;
  ::pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  EXPECT_EQ(sigismember(&blocked, SIGUSR1), 0);
  EXPECT_EQ(sigismember(&blocked, SIGTERM), 0);
  ::pthread_attr_destroy(&huge);
  ::pthread_attr_destroy(&usual);
}

TEST(ProcessTest, RunsSideBySide) {
  std::vector<std::thread> threads;
  std::atomic<int> right{0};
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 5; ++k)
        right += run_process(shell("echo $((6 * 7)); exit " + std::to_string(i))).output == "42\n";
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 40);
}

}  // namespace
}  // namespace pelage
