// SPDX-License-Identifier: Apache-2.0
#include "world/frames.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr size_t kMaxFrames = 1'000'000;
constexpr int kMaxDigits = 9;

[[noreturn]] void fail(const std::string& text, const std::string& why) {
  throw Error(ErrorKind::kArguments,
              quote(text) + ": " + why + "; frames are written as 1-48, 1-48x2 or 1,5,9-12");
}

// Parses an integer at the front of `rest`.
bool take_integer(std::string_view& rest, int& number) {
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc()) return false;
  rest.remove_prefix(static_cast<size_t>(end - rest.data()));
  return true;
}

bool take(std::string_view& rest, char c) {
  if (rest.empty() || rest.front() != c) return false;
  rest.remove_prefix(1);
  return true;
}

struct Range {
  int first = 0, last = 0, step = 1;
};

Range take_range(std::string_view& rest, const std::string& text) {
  Range range;
  if (!take_integer(rest, range.first)) fail(text, "expected a frame number");
  range.last = range.first;
  if (!take(rest, '-')) return range;
  if (!take_integer(rest, range.last)) fail(text, "expected the last frame after '-'");
  if (range.last < range.first) fail(text, "the range ends before it begins");
  if (take(rest, 'x') && (!take_integer(rest, range.step) || range.step < 1)) {
    fail(text, "expected a step of at least 1 after 'x'");
  }
  return range;
}

// A placeholder for the frame number at the start of `text`: its length, and the number of digits to pad to.
struct Place {
  size_t length = 0;
  int digits = 0;
};

// Parses the digits of a width at text[i..]; advances i past them.
int take_width(std::string_view text, size_t& i) {
  int width = 0;
  while (i < text.size() && text[i] >= '0' && text[i] <= '9' && width <= kMaxDigits) {
    width = width * 10 + (text[i++] - '0');
  }
  return width;
}

Place find_place(std::string_view text) {
  size_t i = 1;
  if (text[0] == '#') {
    const size_t end = std::min(text.find_first_not_of('#'), text.size());
    return end <= kMaxDigits ? Place{end, static_cast<int>(end)} : Place{};
  }
  if (text[0] == '%') {
    const int digits = take_width(text, i);
    return i < text.size() && text[i] == 'd' && digits <= kMaxDigits ? Place{i + 1, digits} : Place{};
  }
  if (text[0] == '$' && text.substr(1, 1) == "F") {
    const int digits = take_width(text, ++i);
    return digits <= kMaxDigits ? Place{i, digits} : Place{};
  }
  if (text[0] == '<' && text.substr(1, 1) == "F") {
    const int digits = take_width(text, ++i);
    return i < text.size() && text[i] == '>' && digits <= kMaxDigits ? Place{i + 1, digits} : Place{};
  }
  return {};
}

std::string padded(int frame, int digits) {
  std::string text = std::to_string(std::abs(static_cast<long>(frame)));
  if (text.size() < static_cast<size_t>(digits))
    text.insert(0, static_cast<size_t>(digits) - text.size(), '0');
  return frame < 0 ? "-" + text : text;
}

}  // namespace

FrameList parse_frames(const std::string& text) {
  FrameList list;
  list.frames.clear();
  std::set<int> seen;
  std::string_view rest = text;
  do {
    const Range range = take_range(rest, text);
    for (int64_t frame = range.first; frame <= range.last; frame += range.step) {
      if (!seen.insert(static_cast<int>(frame)).second) continue;
      if (seen.size() > kMaxFrames) fail(text, "more than " + std::to_string(kMaxFrames) + " frames");
      list.frames.push_back(static_cast<int>(frame));
    }
  } while (take(rest, ','));
  if (!rest.empty()) fail(text, "unexpected " + quote(rest));
  return list;
}

std::string print_frames(const FrameList& list) {
  const std::vector<int>& frames = list.frames;
  std::string text;
  for (size_t i = 0; i < frames.size();) {
    size_t end = i + 1;
    const int step = end < frames.size() ? frames[end] - frames[i] : 0;
    while (step > 0 && end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
    if (end - i < 3) end = i + 1;  // two numbers are not a range
    text += (i ? "," : "") + std::to_string(frames[i]);
    if (end - i > 1) text += "-" + std::to_string(frames[end - 1]);
    if (end - i > 1 && step > 1) text += "x" + std::to_string(step);
    i = end;
  }
  return text;
}

bool ValueReader<FrameList>::read(const Value& value, const KeyOptions&, FrameList& out, Problems& problems) {
  if (!value.is_scalar()) {
    problems.add(value.position(), "expected frames, such as 1 or 1-48, got " + value.describe());
    return false;
  }
  try {
    out = parse_frames(value.text());
    return true;
  } catch (const Error& error) {
    problems.add(value.position(), error.what());
    return false;
  }
}

bool has_frame_pattern(std::string_view name) {
  for (size_t i = 0; i < name.size(); ++i) {
    if (name.substr(i, 2) == "%%") {
      ++i;
    } else if (find_place(name.substr(i)).length > 0) {
      return true;
    }
  }
  return false;
}

std::string frame_file_name(std::string_view name, int frame) {
  std::string result;
  for (size_t i = 0; i < name.size();) {
    const Place place = find_place(name.substr(i));
    if (place.length > 0) {
      result += padded(frame, place.digits);
      i += place.length;
    } else {
      result += name[i];
      i += name.substr(i, 2) == "%%" ? 2 : 1;
    }
  }
  return result;
}

void check_output_pattern(const std::string& name, const FrameList& list) {
  if (list.frames.size() < 2 || has_frame_pattern(name)) return;
  throw Error(ErrorKind::kArguments, std::to_string(list.frames.size()) +
                                         " frames cannot all be written to " + quote(name) +
                                         "; put the frame number into the name, as in rat.%04d.exr");
}

}  // namespace pelage
