// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pelage {

/// The candidate that `name` most likely means (optimal string alignment distance, transpositions count as
/// one), or an empty view when no candidate is within max(1, length of `name` / 3).
std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean 'clump'?" or an empty string.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

/// did_you_mean(). If no candidate is similar and the list of candidates is short, returns this list: ";
/// expected one of a, b".
std::string suggest(std::string_view name, std::span<const std::string> candidates);

/// A user's text for a message: quoted, on one line, shortened when it is long.
std::string quote(std::string_view text);

}  // namespace pelage
