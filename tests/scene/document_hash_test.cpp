// SPDX-License-Identifier: Apache-2.0
#include "scene/document_hash.h"

#include <gtest/gtest.h>

#include "scene/document.h"

namespace pelage {
namespace {

ContentHash hash_of(const std::string& text) { return document_hash(parse_document(text, "t")); }

TEST(DocumentHash, IgnoresCommentsPositionsAndStyle) {
  EXPECT_EQ(hash_of("a: 1\nb: [x, y]\n"), hash_of("# hello\n\na:   1\nb:\n  - x\n  - y\n"));
}

TEST(DocumentHash, ChangesWithEveryKeyAndValue) {
  const ContentHash base = hash_of("a: 1\nb: [x, y]\nc: {d: e}\n");
  for (const char* other :
       {"a: 2\nb: [x, y]\nc: {d: e}\n", "a: 1\nb: [x, y, z]\nc: {d: e}\n", "a: 1\nb: [xy]\nc: {d: e}\n",
        "a: 1\nb: [x, y]\nc: {f: e}\n", "a: '1'\nb: [x, y]\nc: {d: e}\n", "a: 1\nb: [x, y]\nc: [d, e]\n"}) {
    EXPECT_NE(hash_of(other), base) << other;
  }
}

}  // namespace
}  // namespace pelage
