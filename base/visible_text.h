// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Returns a text with every control character except line feeds and tabs as "\x1b", so that a terminal shows
/// the characters and does not obey them. For texts from files of other people, such as logs. Other
/// characters stay, also outside ASCII (UTF-8).
std::string visible(std::string_view text);

}  // namespace pelage
