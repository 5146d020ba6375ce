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

/// Hashes integers to 64 bits. The result depends on their order. All random numbers of Pelage are made from
/// such hashes (law 1).
template <class... Words>
constexpr uint64_t hash64(Words... words) {
  uint64_t h = 0x9e3779b97f4a7c15ull;
  ((h = mix64(h ^ static_cast<uint64_t>(words)) + 0x9e3779b97f4a7c15ull), ...);
  return mix64(h);
}

/// Returns a 64-bit constant for one use of random numbers: the FNV-1a hash of its name, computed at compile
/// time. Pass this constant to hash64() together with the id of a strand. Different uses, such as
/// random_use("clump") and random_use("curl"), then get independent random numbers for the same strand. A
/// name stays as it is once it has been used, even if its word has left the code: another name changes all
/// pixels.
consteval uint64_t random_use(std::string_view name) {
  uint64_t h = 0xcbf29ce484222325ull;
  for (char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return h;
}

/// Converts the upper 24 bits of a hash to a float in [0, 1), a multiple of 2^-24.
constexpr float unit_float(uint64_t hash) { return static_cast<float>(hash >> 40) * 0x1p-24f; }
/// Converts the upper 24 bits of a hash to a float in [-1, 1), a multiple of 2^-23.
constexpr float signed_float(uint64_t hash) { return 2.0f * unit_float(hash) - 1.0f; }

/// 128-bit hash of bytes (XXH3). Names of cache files contain such a hash.
struct ContentHash {
  uint64_t low = 0;
  uint64_t high = 0;
  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};
ContentHash content_hash(std::span<const std::byte> bytes, uint64_t seed = 0);
/// Returns the hash as 32 lower-case hexadecimal digits.
std::string to_string(const ContentHash& hash);
/// Parses 32 hexadecimal digits, as to_string() returns them. Returns an empty value for any other text.
std::optional<ContentHash> parse_hash(std::string_view text);

/// Computes the content hash of a sequence of values. The length of each text or list is hashed before its
/// elements, so the sequence "ab", "c" has another hash than "a", "bc". A number is hashed as the bytes of
/// its type: 1.0f, 1.0 and 1 have three different hashes, and 0.0 and -0.0 have different hashes too.
class ContentHasher {
 public:
  ContentHasher();
  ~ContentHasher();
  ContentHasher(ContentHasher&&) noexcept;
  ContentHasher& operator=(ContentHasher&&) noexcept;

  /// Adds only the bytes; does not add their count first.
  ContentHasher& add_bytes(std::span<const std::byte> bytes);
  ContentHasher& add(std::string_view text);
  ContentHasher& add(const char* text) { return add(std::string_view(text)); }
  ContentHasher& add(const ContentHash& hash) { return add(hash.low).add(hash.high); }
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number> ContentHasher& add(Number value) {
    return add_bytes(std::as_bytes(std::span(&value, 1)));
  }
  /// Adds the count of the elements, then their bytes. The element type must have no padding bytes.
  template <class T>
  requires std::is_trivially_copyable_v<T> ContentHasher& add(std::span<const T> values) {
    return add(static_cast<uint64_t>(values.size())).add_bytes(std::as_bytes(values));
  }
  /// Returns the hash of everything added so far. More values may be added afterwards.
  ContentHash digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pelage
