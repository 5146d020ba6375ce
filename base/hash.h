// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace pelage {

/// Finaliser of SplitMix64: a bijection on 64 bits with good mixing.
constexpr uint64_t mix64(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Hash of a few words, order-dependent. The source of all random numbers of Pelage (law 1).
template <class... Words>
constexpr uint64_t hash64(Words... words) {
  uint64_t h = 0x9e3779b97f4a7c15ull;
  ((h = mix64(h ^ static_cast<uint64_t>(words)) + 0x9e3779b97f4a7c15ull), ...);
  return mix64(h);
}

/// The purpose of a random number, as a word of hash64: `random_use("clump")`. Separates the streams of
/// different uses for one strand. FNV-1a, computed by the compiler.
consteval uint64_t random_use(std::string_view name) {
  uint64_t h = 0xcbf29ce484222325ull;
  for (char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return h;
}

/// Upper bits of a hash as a float in [0, 1), every value a multiple of 2^-24.
constexpr float unit_float(uint64_t hash) { return static_cast<float>(hash >> 40) * 0x1p-24f; }
/// The same in [-1, 1).
constexpr float signed_float(uint64_t hash) { return 2.0f * unit_float(hash) - 1.0f; }

/// 128-bit content hash (XXH3) of bytes, used to name caches by content.
struct ContentHash {
  uint64_t low = 0;
  uint64_t high = 0;
  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};
ContentHash content_hash(std::span<const std::byte> bytes, uint64_t seed = 0);
/// 32 hexadecimal digits.
std::string to_string(const ContentHash& hash);
/// Parses the output of to_string; empty for other texts.
std::optional<ContentHash> parse_hash(std::string_view text);

/// Content hash of a sequence of values. Texts and lists are preceded by their length, so that "ab", "c" and
/// "a", "bc" differ. Numbers are hashed as bytes: 1.0f, 1.0 and 1 differ, as do 0 and -0.
class ContentHasher {
 public:
  ContentHasher();
  ~ContentHasher();
  ContentHasher(ContentHasher&&) noexcept;
  ContentHasher& operator=(ContentHasher&&) noexcept;

  /// The bytes only, without their number.
  ContentHasher& add_bytes(std::span<const std::byte> bytes);
  ContentHasher& add(std::string_view text);
  ContentHasher& add(const char* text) { return add(std::string_view(text)); }
  ContentHasher& add(const ContentHash& hash) { return add(hash.low).add(hash.high); }
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number> ContentHasher& add(Number value) {
    return add_bytes(std::as_bytes(std::span(&value, 1)));
  }
  /// Elements must have no padding: their bytes are hashed.
  template <class T>
  requires std::is_trivially_copyable_v<T> ContentHasher& add(std::span<const T> values) {
    return add(static_cast<uint64_t>(values.size())).add_bytes(std::as_bytes(values));
  }
  /// Hash of everything added so far; more may be added afterwards.
  ContentHash digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pelage
