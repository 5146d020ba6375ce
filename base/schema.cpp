// SPDX-License-Identifier: Apache-2.0
#include "base/schema.h"

#include <algorithm>
#include <cmath>

#include "base/nearest_name.h"
#include "base/value_readers.h"

namespace pelage {

std::string range_text(const KeyOptions& options) {
  const bool has_min = std::isfinite(options.min);
  const bool has_max = std::isfinite(options.max);
  const std::string min = ValueReader<double>::print(options.min);
  const std::string max = ValueReader<double>::print(options.max);
  if (has_min && has_max) return options.above_min ? "> " + min + ", <= " + max : min + " .. " + max;
  if (has_min) return (options.above_min ? "> " : ">= ") + min;
  if (has_max) return "<= " + max;
  return {};
}

std::vector<std::string> SchemaInfo::key_names() const {
  std::vector<std::string> names;
  names.reserve(keys_.size());
  for (const KeyInfo& key : keys_) names.push_back(key.name);
  return names;
}

bool KeyInfo::has_old_name(std::string_view old_name) const {
  return std::find(options.old_names.begin(), options.old_names.end(), old_name) != options.old_names.end();
}

const KeyInfo* SchemaInfo::find(std::string_view name) const {
  const auto key = std::find_if(keys_.begin(), keys_.end(), [&](const KeyInfo& k) { return k.name == name; });
  return key == keys_.end() ? nullptr : &*key;
}

const KeyInfo* SchemaInfo::find_renamed(std::string_view old_name) const {
  const auto key =
      std::find_if(keys_.begin(), keys_.end(), [&](const KeyInfo& k) { return k.has_old_name(old_name); });
  return key == keys_.end() ? nullptr : &*key;
}

namespace detail {

void report_unknown_key(const Value::Entry& entry, const SchemaInfo& schema, Problems& problems) {
  if (const KeyInfo* renamed = schema.find_renamed(entry.key)) {
    problems.add(entry.key_position, quote(entry.key) + " is now called " + quote(renamed->name));
    return;
  }
  for (const Removed& removed : schema.removed()) {
    if (removed.name != entry.key) continue;
    const bool harmless = entry.value.is_scalar() && entry.value.text() == removed.harmless;
    if (!harmless || removed.harmless.empty())
      problems.add(entry.key_position, quote(entry.key) + " was removed: " + removed.advice);
    return;
  }
  const std::vector<std::string> names = schema.key_names();
  problems.add(entry.key_position,
               "unknown key " + quote(entry.key) + " in " + schema.name() + suggest(entry.key, names));
}

void report_missing_key(const Value& block, const SchemaInfo& schema, const std::string& key,
                        Problems& problems) {
  problems.add(block.position(), schema.name() + " needs the key '" + key + "'");
}

bool expect_map(const Value& value, const SchemaInfo& schema, Problems& problems) {
  if (value.is_map()) return true;
  problems.add(value.position(), "expected a block of keys (" + schema.name() + "), got " + value.describe());
  return false;
}

}  // namespace detail
}  // namespace pelage
