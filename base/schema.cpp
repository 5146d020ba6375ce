// SPDX-License-Identifier: Apache-2.0
#include "base/schema.h"

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

namespace detail {

void report_unknown_key(const Value::Entry& entry, const SchemaInfo& schema, Problems& problems) {
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
