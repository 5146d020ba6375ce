// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/value_readers.h"

namespace pelage {

/// Frames to render, in the given order, without duplicates.
struct FrameList {
  std::vector<int> frames{1};
};

/// Parses a frame "7", a range "1-48" or "-5--1", a range with a step "1-48x2", or a list of these separated
/// by commas, "1,5,9-12". Removes duplicates. Throws Error (kArguments) with the reason when the text is
/// malformed or has more than 1,000,000 frames.
FrameList parse_frames(const std::string& text);

/// Returns a text that parse_frames() converts to the same list, such as "1-12". Writes three or more frames
/// with equal steps as a range.
std::string print_frames(const FrameList& list);

/// Reads the key `frames` of a scene: a number, or a text for parse_frames().
template <>
struct ValueReader<FrameList> {
  static bool read(const Value&, const KeyOptions&, FrameList& out, Problems&);
  static std::string type_name() { return "frames"; }
  static std::string print(const FrameList& list) { return print_frames(list); }
};

/// Returns whether a file name contains a placeholder for the frame number: %04d, %d, ####, $F4, $F, <F4> or
/// <F>. The digit, or the count of #, is the min number of digits.
bool has_frame_pattern(std::string_view name);

/// Replaces each placeholder of a file name by the frame number, and `%%` by `%`. The minus sign of a
/// negative number does not count as a digit: %04d becomes -0003 for frame -3.
std::string frame_file_name(std::string_view name, int frame);

/// Throws Error (kArguments) when the list has several frames but `name` has no placeholder, so that all
/// frames would be written to the same file.
void check_output_pattern(const std::string& name, const FrameList& list);

}  // namespace pelage
