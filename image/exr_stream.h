// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>

#include <OpenEXR/ImfIO.h>

#include "base/file.h"

// Include this header only in image/.

namespace pelage {

/// Lets OpenEXR write to an AtomicFile without an intermediate buffer. Also stores the exception of the first
/// failed write, because OpenEXR writes its table of rows in a destructor that swallows exceptions.
class ExrStream final : public Imf::OStream {
 public:
  explicit ExrStream(AtomicFile& file) : OStream(file.temporary_path().c_str()), file_(file) {}

  void write(const char bytes[], int count) override;
  uint64_t tellp() override { return place_; }
  void seekp(uint64_t place) override { place_ = place; }

  /// Throws the exception of the first failed write, if any.
  void check() const;

 private:
  AtomicFile& file_;
  uint64_t place_ = 0;
  std::exception_ptr failure_;
};

}  // namespace pelage
