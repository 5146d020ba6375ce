// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_layer.h"

#include <algorithm>
#include <cstring>

namespace pelage {
namespace {

/// Bytes of text per known line.
constexpr size_t kTextPerMark = 1 << 14;

int to_position(size_t n) { return static_cast<int>(std::min<size_t>(n, 2'000'000'000)) + 1; }

}  // namespace

const UsdAttribute* UsdPrimSpec::find(std::string_view attribute) const {
  const auto found = attribute_index.find(attribute);
  return found == attribute_index.end() ? nullptr : &attributes[found->second];
}

const UsdPrimSpec* UsdPrimSpec::child(std::string_view child_name) const {
  const auto found = child_index.find(child_name);
  return found == child_index.end() ? nullptr : &children[found->second];
}

/// Files may give a warning for each of a million prims, so the lines before a place are not counted each
/// time.
void UsdLayer::mark_lines() const {
  LineMark mark;
  for (size_t begin = 0; begin < text_.size(); begin += kTextPerMark) {
    marks_.push_back(mark);
    const std::string_view part = text_.substr(begin, kTextPerMark);
    mark.lines += static_cast<size_t>(std::count(part.begin(), part.end(), '\n'));
    if (const size_t last = part.rfind('\n'); last != std::string_view::npos)
      mark.line_begin = begin + last + 1;
  }
  if (marks_.empty()) marks_.push_back(mark);
}

SourcePosition UsdLayer::position(size_t place) const {
  std::call_once(marked_, [this] { mark_lines(); });
  place = std::min(place, text_.size());
  const size_t at = std::min(place / kTextPerMark, marks_.size() - 1);
  LineMark mark = marks_[at];
  const std::string_view part = text_.substr(at * kTextPerMark, place - at * kTextPerMark);
  mark.lines += static_cast<size_t>(std::count(part.begin(), part.end(), '\n'));
  if (const size_t last = part.rfind('\n'); last != std::string_view::npos)
    mark.line_begin = at * kTextPerMark + last + 1;
  return {path_.string(), to_position(mark.lines), to_position(place - mark.line_begin)};
}

void UsdLayer::fail(size_t place, const std::string& message) const {
  throw Error(ErrorKind::kInput, position(place), message);
}

}  // namespace pelage
