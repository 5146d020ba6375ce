// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pelage {

/// Returns the candidate with the smallest edit distance from `name`, or an empty view when every distance
/// exceeds max(1, length of `name` / 3). The edit distance is the optimal string alignment distance, in which
/// a transposition of two neighbours counts as one edit. Names longer than 64 bytes match nothing.
std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Returns "; did you mean 'clump'?" with the nearest_name(), or an empty string when there is none.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

/// Returns did_you_mean(). If this is empty and there are at most 12 candidates, returns a list of them
/// instead: "; expected one of a, b".
std::string suggest(std::string_view name, std::span<const std::string> candidates);

/// Formats a text from the user for a message: in quotes, with '?' for control characters, cut after 40
/// bytes.
std::string quote(std::string_view text);

}  // namespace pelage
