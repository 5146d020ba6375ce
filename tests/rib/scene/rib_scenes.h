// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "rib/scene/rib_reading.h"
#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage::rib_test {

inline const std::string kHair =
    "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 1 0] \"constantwidth\" 0.1\n";

inline RibScene read(const std::string& text, const RibReadOptions& options = {}) {
  const Files files;
  return read_rib(files.write(text), options);
}

inline std::string failure(const std::string& text, const RibReadOptions& options = {}) {
  const std::string message = error_of([&] { read(text, options); });
  return message.substr(message.find("a.rib") == std::string::npos ? 0 : message.find("a.rib"));
}

// The first strand's points of all coats, in order.
inline std::vector<V3f> tips(const RibScene& scene, int key = 0) {
  std::vector<V3f> tips;
  for (const RibCoat& coat : scene.coats) {
    for (const auto& batch : coat.batches) {
      for (size_t s = 0; s < batch->strand_count(); ++s)
        tips.push_back(batch->point(batch->first_point(s) + 1, key));
    }
  }
  return tips;
}

inline V3f tip(const std::string& text) {
  const std::vector<V3f> all = tips(read(text));
  return all.size() == 1 ? all[0] : V3f(-999);
}

inline void expect_near(const V3f& is, const V3f& should) {
  EXPECT_LT((is - should).length(), 1e-5f) << is << should;
}

}  // namespace pelage::rib_test
