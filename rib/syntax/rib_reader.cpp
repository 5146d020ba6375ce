// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_reader.h"

#include <fmt/format.h>

namespace pelage {
namespace {

constexpr size_t kMaxArguments = 10'000;

}  // namespace

std::string RibOperand::describe() const {
  const char* one = kind == Kind::kStrings ? "string" : kind == Kind::kFloats ? "number" : "integer";
  if (is_array) return fmt::format("an array of {} {}s", size(), one);
  return fmt::format("{} {}", kind == Kind::kIntegers ? "an" : "a", one);
}

void RibStatement::fail(const std::string& why) const {
  throw Error(ErrorKind::kInput, position(), name + ": " + why);
}

void RibStatement::fail(const RibOperand& argument, const std::string& why) const {
  throw Error(ErrorKind::kInput, position(argument), name + ": " + why);
}

size_t RibStatement::bytes() const {
  size_t sum = sizeof(*this) + name.capacity() + file.capacity();
  for (const RibOperand& a : arguments) {
    sum += sizeof a + 8 * a.integers.capacity() + 4 * a.floats.capacity();
    for (const std::string& s : a.strings) sum += sizeof s + s.capacity();
  }
  return sum;
}

RibOperand& RibReader::add_argument(RibStatement& request) {
  if (used_ == kMaxArguments) request.fail(fmt::format("more than {} arguments", kMaxArguments));
  if (used_ == request.arguments.size()) request.arguments.emplace_back();
  RibOperand& argument = request.arguments[used_++];
  argument.kind = RibOperand::Kind::kIntegers;
  argument.is_array = false;
  argument.line = lexer_.line();
  argument.column = lexer_.column();
  argument.integers.clear();
  argument.floats.clear();
  argument.strings.clear();
  return argument;
}

void RibReader::append_number(RibOperand& argument) {
  if (argument.kind == RibOperand::Kind::kFloats) {
    argument.floats.push_back(static_cast<float>(lexer_.number()));
    return;
  }
  // The first float makes the array one of floats.
  argument.kind = RibOperand::Kind::kFloats;
  argument.floats.assign(argument.integers.begin(), argument.integers.end());
  argument.integers.clear();
  argument.floats.push_back(static_cast<float>(lexer_.number()));
}

void RibReader::read_array(RibStatement& request) {
  RibOperand& argument = add_argument(request);
  argument.is_array = true;
  for (;;) {
    const RibToken token = lexer_.next();
    if (token == RibToken::kClose) return;
    const auto fail = [&](const char* why) { throw Error(ErrorKind::kInput, lexer_.position(), why); };
    if (token == RibToken::kEnd || token == RibToken::kRequest) fail("an array has no closing bracket");
    if (token == RibToken::kOpen || token == RibToken::kFloats) fail("an array within an array");
    if (argument.size() >= kMaxRibCount) fail("an array has more than 1,000,000,000 elements");
    charge(token == RibToken::kString ? sizeof(std::string) + lexer_.text().size() : sizeof(int64_t));
    if (token == RibToken::kString) {
      if (argument.is_number() && argument.size() > 0) fail("an array of numbers contains a string");
      argument.kind = RibOperand::Kind::kStrings;
      argument.strings.push_back(lexer_.text());
      continue;
    }
    if (!argument.is_number()) fail("an array of strings contains a number");
    if (token == RibToken::kFloat) {
      append_number(argument);
    } else if (argument.kind == RibOperand::Kind::kFloats) {
      argument.floats.push_back(static_cast<float>(lexer_.integer()));
    } else {
      argument.integers.push_back(lexer_.integer());
    }
  }
}

void RibReader::read_value(RibStatement& request, RibToken token) {
  if (token == RibToken::kOpen) {
    read_array(request);
    return;
  }
  RibOperand& argument = add_argument(request);
  if (token == RibToken::kString) {
    argument.kind = RibOperand::Kind::kStrings;
    argument.strings.push_back(lexer_.text());
  } else if (token == RibToken::kInteger) {
    argument.integers.push_back(lexer_.integer());
  } else if (token == RibToken::kFloat) {
    append_number(argument);
  } else if (token == RibToken::kFloats) {
    argument.kind = RibOperand::Kind::kFloats;
    argument.is_array = true;
    lexer_.swap_floats(argument.floats);
  } else {
    throw Error(ErrorKind::kInput, lexer_.position(), "a closing bracket without an opening one");
  }
}

bool RibReader::next(RibStatement& request) {
  if (!started_) ahead_ = lexer_.next();
  started_ = true;
  if (ahead_ == RibToken::kEnd) return false;
  if (ahead_ != RibToken::kRequest)
    throw Error(ErrorKind::kInput, lexer_.position(), "expected the name of a request, got a value");
  request.name = lexer_.text();
  if (request.file != lexer_.file()) request.file = lexer_.file();
  request.line = lexer_.line();
  request.column = lexer_.column();
  used_ = 0;
  charged_ = 0;
  allowed_ = kUnchecked;
  for (ahead_ = lexer_.next(); ahead_ != RibToken::kRequest && ahead_ != RibToken::kEnd;
       ahead_ = lexer_.next())
    read_value(request, ahead_);
  request.arguments.resize(used_);
  return true;
}

}  // namespace pelage
