// SPDX-License-Identifier: Apache-2.0
#include "base/keyed.h"

#include "base/nearest_name.h"

namespace pelage::detail {

bool read_key_frames(const Value& value, std::vector<std::pair<double, const Value*>>& frames, bool& is_keyed,
                     Problems& problems) {
  static const std::vector<std::string> kNames{"keys"};
  is_keyed = value.is_map();
  if (!is_keyed) return true;
  const size_t before = problems.list().size();
  for (const Value::Entry& entry : value.entries()) {
    if (entry.key == "keys") continue;
    problems.add(entry.key_position,
                 "unknown key " + quote(entry.key) + " in a value with keys" + suggest(entry.key, kNames));
  }
  const Value* keys = value.find("keys");
  if (keys == nullptr) {
    if (value.entries().empty())
      problems.add(value.position(), "expected {keys: {frame: value, ...}}, got {}");
    return false;
  }
  if (!keys->is_map() || keys->entries().empty()) {
    problems.add(keys->position(),
                 "expected a map from frames to values, {1: a, 48: b}, got " + keys->describe());
    return false;
  }
  for (const Value::Entry& entry : keys->entries()) {
    const std::optional<double> frame = parse_number(entry.key);
    if (!frame) {
      problems.add(entry.key_position, "expected a frame number, got " + quote(entry.key));
      continue;
    }
    frames.push_back({*frame, &entry.value});
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].first != frames[i - 1].first) continue;
    problems.add(frames[i].second->position(),
                 "frame " + ValueReader<double>::print(frames[i].first) + " has two values");
  }
  return problems.list().size() == before;
}

}  // namespace pelage::detail
