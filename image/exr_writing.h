// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "image/exr_file.h"

namespace pelage {

/// Returns the memory that write_exr() takes for these channels, in bytes: what it charges to the ledger.
/// `width` and `height`: of the data window. `threads`: thread count of the workers.
int64_t exr_writing_bytes(const std::vector<ExrChannel>& channels, int width, int height, int threads);

/// Returns ExrWriter::buffer_bytes() of a writer of this picture, without making a file.
int64_t exr_buffer_bytes(const ExrPart& part, int threads);

}  // namespace pelage
