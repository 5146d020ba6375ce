// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/value_readers.h"

namespace pelage {

/// A number or vector that may be animated. A scene contains either a constant or values at frames, such as
/// {keys: {1: v, 48: v}}. Values are interpolated linearly between keys, and constant before the first and
/// after the last key.
template <class T>
class Keyed {
 public:
  Keyed() = default;
  Keyed(T constant) : keys_{{0.0, constant}} {}
  /// `keys` must be sorted by frame and not empty.
  explicit Keyed(std::vector<std::pair<double, T>> keys) : keys_(std::move(keys)) {}

  /// Returns the value at a frame; 0 if default-constructed.
  T at(double frame) const {
    if (keys_.empty()) return T(0);
    auto after = std::upper_bound(keys_.begin(), keys_.end(), frame,
                                  [](double f, const auto& key) { return f < key.first; });
    if (after == keys_.begin()) return keys_.front().second;
    if (after == keys_.end()) return keys_.back().second;
    const auto& [f0, a] = *(after - 1);
    const auto& [f1, b] = *after;
    const float t = static_cast<float>((frame - f0) / (f1 - f0));
    return a * (1.0f - t) + b * t;
  }
  bool is_constant() const { return keys_.size() <= 1; }
  const std::vector<std::pair<double, T>>& keys() const { return keys_; }

 private:
  std::vector<std::pair<double, T>> keys_;
};

/// Returns the values relative to `origin`. Subtracts it from each key: interpolated coordinates far from the
/// origin would be rounded.
template <class T>
Keyed<T> relative_to(const Keyed<T>& values, const T& origin) {
  std::vector<std::pair<double, T>> keys = values.keys();
  if (keys.empty()) keys.push_back({0.0, T(0)});
  for (auto& [frame, value] : keys) value -= origin;
  return Keyed<T>(std::move(keys));
}

namespace detail {
/// Reads the frames of a {keys: {frame: value}} block and appends each with its value to `frames`, sorted by
/// frame. Sets `is_keyed` to whether `value` is a map. If not, appends nothing and returns true. Adds a
/// problem for a malformed map, an unknown key, and a frame that is not a number or occurs twice. Returns
/// whether no problem was found.
bool read_key_frames(const Value& value, std::vector<std::pair<double, const Value*>>& frames, bool& is_keyed,
                     Problems& problems);
}  // namespace detail

template <class T>
struct ValueReader<Keyed<T>> {
  static bool read(const Value& value, const KeyOptions& options, Keyed<T>& out, Problems& problems) {
    std::vector<std::pair<double, const Value*>> frames;
    bool is_keyed = false;
    if (!detail::read_key_frames(value, frames, is_keyed, problems)) return false;
    if (!is_keyed) {
      T constant(0);
      if (!ValueReader<T>::read(value, options, constant, problems)) return false;
      out = Keyed<T>(constant);
      return true;
    }
    std::vector<std::pair<double, T>> keys;
    bool good = true;
    for (const auto& [frame, entry] : frames) {
      keys.push_back({frame, T(0)});
      good &= ValueReader<T>::read(*entry, options, keys.back().second, problems);
    }
    if (good) out = Keyed<T>(std::move(keys));
    return good;
  }
  static std::string type_name() { return ValueReader<T>::type_name() + ", or keys"; }
  static std::string print(const Keyed<T>& v) { return ValueReader<T>::print(v.at(0)); }
};

}  // namespace pelage
