// SPDX-License-Identifier: Apache-2.0
#include "image/exr_stream.h"

#include <cstddef>
#include <exception>
#include <span>

namespace pelage {

void ExrStream::write(const char bytes[], int count) {
  try {
    file_.write_at(place_, std::as_bytes(std::span(bytes, static_cast<size_t>(count))));
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
    throw;
  }
  place_ += static_cast<uint64_t>(count);
}

void ExrStream::check() const {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace pelage
