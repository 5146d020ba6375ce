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

/// Reads "7", "1-48", "1-48x2", "-5--1" and lists of these, "1,5,9-12". Throws Error (kArguments) with the
/// reason, also for more than 1,000,000 frames.
FrameList parse_frames(const std::string& text);

/// The shortest text from which parse_frames reads the same list: "1-12".
std::string print_frames(const FrameList& list);

/// `frames:` of a scene: a number or a text for parse_frames.
template <>
struct ValueReader<FrameList> {
  static bool read(const Value&, const KeyOptions&, FrameList& out, Problems&);
  static std::string type_name() { return "frames"; }
  static std::string print(const FrameList& list) { return print_frames(list); }
};

/// Whether a file name contains a placeholder for the frame number: %04d, %d, ####, $F4, $F, <F4> or <F>.
bool has_frame_pattern(std::string_view name);

/// The name with the frame number in place of all placeholders; `%%` becomes `%`. Negative numbers keep their
/// digits: %04d of -3 is -0003.
std::string frame_file_name(std::string_view name, int frame);

/// Throws Error (kArguments) when several frames would be written to one file.
void check_output_pattern(const std::string& name, const FrameList& list);

}  // namespace pelage
