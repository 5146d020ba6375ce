// SPDX-License-Identifier: Apache-2.0
#include "base/schema.h"

#include <algorithm>
#include <cmath>

#include "base/nearest_name.h"
#include "base/value_readers.h"

namespace pelage {
namespace {

/// Adds a problem, unless the key is a removed one with its harmless value. `skip`: a key that another table
/// reads, or "".
void report_unknown_key(const Value::Entry& entry, const SchemaInfo& schema, std::string_view skip,
                        Problems& problems) {
  if (const KeyInfo* renamed = schema.find_renamed(entry.key)) {
    problems.add(entry.key_position, quote(entry.key) + " is now called " + quote(renamed->name));
    return;
  }
  for (const Removed& removed : schema.removed()) {
    if (removed.name != entry.key) continue;
    const bool harmless = entry.value.is_scalar() && entry.value.text() == removed.harmless;
    if (!harmless || removed.harmless.empty())
      problems.add(entry.key_position, quote(entry.key) + " was removed: " + std::string(removed.advice));
    return;
  }
  std::vector<std::string> names = schema.key_names();
  if (!skip.empty()) names.emplace_back(skip);
  problems.add(entry.key_position,
               "unknown key " + quote(entry.key) + " in " + schema.name() + suggest(entry.key, names));
}

}  // namespace

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
  if (old_name.empty()) return false;
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

void SchemaInfo::add_key(std::string_view name, const detail::ValueType& type, size_t offset,
                         const void* default_value, const KeyOptions& options) {
  std::string shown(options.default_text);
  if (shown.empty() && !options.required) shown = type.print(default_value);
  keys_.push_back(
      {std::string(name), type.type_name(), std::move(shown), options, type.blocks(), type.visit_blocks});
  members_.push_back({&type, offset});
}

std::vector<ParameterText> SchemaInfo::describe_members(const void* params, const std::string& prefix) const {
  std::vector<ParameterText> out;
  for (size_t i = 0; i < keys_.size(); ++i)
    members_[i].type->describe(static_cast<const char*>(params) + members_[i].offset, prefix + keys_[i].name,
                               out);
  return out;
}

bool SchemaInfo::read_members(const Value& value, void* params, Problems& problems,
                              std::string_view skip) const {
  if (!value.is_map()) {
    problems.add(value.position(), "expected a block of keys (" + name_ + "), got " + value.describe());
    return false;
  }
  const size_t before = problems.list().size();
  std::vector<bool> seen(keys_.size(), false);
  for (const Value::Entry& entry : value.entries()) {
    if (!skip.empty() && entry.key == skip) continue;
    const KeyInfo* key = find(entry.key);
    if (!key) {
      report_unknown_key(entry, *this, skip, problems);
      continue;
    }
    const size_t i = key - keys_.data();
    seen[i] = true;
    members_[i].type->read(entry.value, key->options, static_cast<char*>(params) + members_[i].offset,
                           problems);
  }
  for (size_t i = 0; i < keys_.size(); ++i) {
    if (keys_[i].options.required && !seen[i])
      problems.add(value.position(), name_ + " needs the key '" + keys_[i].name + "'");
  }
  return problems.list().size() == before;
}

}  // namespace pelage
