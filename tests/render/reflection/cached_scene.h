// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "tests/render/film/film_picture.h"
#include "tests/render/gather/gather_scene.h"
#include "tests/support/effort.h"

namespace pelage::reflection_cache_test {

struct CachedScene : GatherScene {
  CachedScene() {
    render.bounces = 5;
    render.gather.cache = true;
    render.gather.cache_paths = kSanitized ? 16 : 40;  // enough to fill the cells of so small a picture
  }
};

inline void expect_same(const Film& a, const Film& b) {
  const ExrImage one = picture_of(a), other = picture_of(b);
  ASSERT_EQ(one.channels.size(), other.channels.size());
  for (size_t i = 0; i < one.channels.size(); ++i)
    EXPECT_EQ(one.channels[i].pixels, other.channels[i].pixels) << one.channels[i].name;
}

}  // namespace pelage::reflection_cache_test
