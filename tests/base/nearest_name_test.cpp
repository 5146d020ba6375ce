// SPDX-License-Identifier: Apache-2.0
#include "base/nearest_name.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

const std::vector<std::string> kOperators{"length", "comb",  "bend",  "clump",
                                          "curl",   "frizz", "width", "color"};

TEST(NearestName, FindsWhatWasMeant) {
  EXPECT_EQ(nearest_name("clmup", kOperators), "clump");  // a swap
  EXPECT_EQ(nearest_name("lenght", kOperators), "length");
  EXPECT_EQ(nearest_name("colour", kOperators), "color");  // an insertion
  EXPECT_EQ(nearest_name("friz", kOperators), "frizz");    // a deletion
  EXPECT_EQ(nearest_name("curk", kOperators), "curl");     // a substitution
  EXPECT_EQ(nearest_name("comb", kOperators), "comb");
}

TEST(NearestName, FindsNothingFarAway) {
  EXPECT_EQ(nearest_name("banana", kOperators), "");
  EXPECT_EQ(nearest_name("", kOperators), "");
  EXPECT_EQ(nearest_name("clump", {}), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'c'), kOperators), "");
}

// The definition, spelt out: optimal string alignment by recursion.
size_t slow_distance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const auto cut = [](std::string_view s, size_t n) { return s.substr(0, s.size() - n); };
  size_t best = slow_distance(cut(a, 1), cut(b, 1)) + (a.back() != b.back());
  best = std::min({best, slow_distance(cut(a, 1), b) + 1, slow_distance(a, cut(b, 1)) + 1});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    best = std::min(best, slow_distance(cut(a, 2), cut(b, 2)) + 1);
  }
  return best;
}

std::string random_word(uint64_t seed) {
  std::string word;
  const uint64_t length = 1 + hash64(seed, 0) % 5;
  for (uint64_t i = 1; i <= length; ++i) word += static_cast<char>('a' + hash64(seed, i) % 3);
  return word;
}

TEST(NearestName, IsTheFirstOfLeastDistance) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const std::string name = random_word(hash64(seed, 1000));
    std::vector<std::string> words;
    for (uint64_t i = 0; i < 4; ++i) words.push_back(random_word(hash64(seed, i, 2000)));
    const auto nearest = std::min_element(words.begin(), words.end(), [&](const auto& a, const auto& b) {
      return slow_distance(name, a) < slow_distance(name, b);
    });
    const bool near = slow_distance(name, *nearest) <= std::max<size_t>(1, name.size() / 3);
    EXPECT_EQ(nearest_name(name, words), near ? *nearest : "") << name;
  }
}

TEST(NearestName, Words) {
  EXPECT_EQ(did_you_mean("clmup", kOperators), "; did you mean 'clump'?");
  EXPECT_EQ(did_you_mean("banana", kOperators), "");
  EXPECT_EQ(suggest("clmup", kOperators), "; did you mean 'clump'?");
  EXPECT_EQ(suggest("banana", std::vector<std::string>{"box", "triangle"}),
            "; expected one of box, triangle");
  EXPECT_EQ(suggest("banana", std::vector<std::string>{"keys"}), "; expected keys");
  EXPECT_EQ(suggest("banana", std::vector<std::string>(50, "something")), "");
}

}  // namespace
}  // namespace pelage
