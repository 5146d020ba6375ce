// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "view/command_answer.h"
#include "why/pixel_why.h"

namespace pelage {

/// Explains a pixel for a client (why_json()). Errors become answers. Returns nothing if `must_end` returned
/// true before the end; it is called from any thread.
std::optional<CommandAnswer> why_answer(const ExplainedFrame& frame, int x, int y, const Workers& workers,
                                        MemoryLedger& ledger, const std::function<bool()>& must_end);

/// The answer while there is no picture.
CommandAnswer no_picture_answer();

}  // namespace pelage
