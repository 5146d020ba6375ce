// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

namespace pelage {

/// Finaliser of SplitMix64: a bijection on 64 bits that mixes well.
constexpr uint64_t mix64(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Hash of a few words, order included. All random numbers of Pelage start here (law 1).
template <class... Words>
constexpr uint64_t hash64(Words... words) {
  uint64_t h = 0x9e3779b97f4a7c15ull;
  ((h = mix64(h ^ static_cast<uint64_t>(words)) + 0x9e3779b97f4a7c15ull), ...);
  return mix64(h);
}

/// What a random number is for, as a word of hash64: `random_use("clump")`. Keeps the streams of different
/// uses of one strand apart. FNV-1a, computed by the compiler.
consteval uint64_t random_use(std::string_view name) {
  uint64_t h = 0xcbf29ce484222325ull;
  for (char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return h;
}

/// Upper bits of a hash as a float in [0, 1), every value a multiple of 2^-24.
constexpr float unit_float(uint64_t hash) { return static_cast<float>(hash >> 40) * 0x1p-24f; }
/// The same in [-1, 1).
constexpr float signed_float(uint64_t hash) { return 2.0f * unit_float(hash) - 1.0f; }

/// 128-bit content hash (XXH3) of bytes, for naming caches by content.
struct ContentHash {
  uint64_t low = 0;
  uint64_t high = 0;
  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};
ContentHash content_hash(std::span<const std::byte> bytes, uint64_t seed = 0);

}  // namespace pelage
