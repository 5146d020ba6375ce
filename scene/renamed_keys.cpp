// SPDX-License-Identifier: Apache-2.0
#include "scene/renamed_keys.h"

#include <algorithm>
#include <unordered_map>

#include "base/nearest_name.h"

namespace pelage {
namespace {

// Entries of `over` win; entries that only `base` has keep their place.
void merge_maps(Value& base, Value& over) {
  std::unordered_map<std::string, size_t> places;
  for (size_t i = 0; i < base.entries().size(); ++i) places.emplace(base.entries()[i].key, i);
  for (Value::Entry& entry : over.entries()) {
    const auto place = places.find(entry.key);
    if (place == places.end()) {
      base.entries().push_back(std::move(entry));
    } else {
      Value::Entry& old = base.entries()[place->second];
      old.key_position = entry.key_position;
      merge_into(old.value, std::move(entry.value));
    }
  }
  base.set_position(over.position());
}

// A file that is included twice is warned about once.
void warn(const Value::Entry& entry, const KeyInfo& key, std::vector<Problem>& warnings) {
  const std::string message = quote(entry.key) + " is now called " + quote(key.name);
  const bool known = std::any_of(warnings.begin(), warnings.end(), [&](const Problem& problem) {
    return to_string(problem.position) == to_string(entry.key_position) && problem.message == message;
  });
  if (!known) warnings.push_back({entry.key_position, message});
}

void rename_in_block(Value& block, const SchemaInfo& table, BothNames both, RenamedKeys& renamed,
                     Problems& problems) {
  if (!block.is_map()) return;
  std::vector<Value::Entry>& entries = block.entries();
  for (size_t i = 0; i < entries.size(); ++i) {
    const KeyInfo* key = table.find(entries[i].key) ? nullptr : table.find_renamed(entries[i].key);
    if (!key) continue;
    warn(entries[i], *key, renamed.warnings);
    Value* present = block.find(key->name);
    if (!present) {
      entries[i].key = key->name;
      continue;
    }
    if (both == BothNames::kRefuse) {
      problems.add(entries[i].key_position, quote(entries[i].key) + " is the old name of " +
                                                quote(key->name) + "; give only one of them");
    } else {
      merge_into(*present, std::move(entries[i].value));
    }
    entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(i--));
  }
  for (Value::Entry& entry : entries) {
    const KeyInfo* key = table.find(entry.key);
    if (!key) continue;
    key->visit_blocks(entry.value, [&](Value& inner, const SchemaInfo& inner_table) {
      rename_in_block(inner, inner_table, both, renamed, problems);
    });
  }
}

}  // namespace

void merge_into(Value& base, Value over) {
  if (base.is_map() && over.is_map()) {
    merge_maps(base, over);
  } else {
    base = std::move(over);
  }
}

void rename_old_keys(Value& document, BothNames both, RenamedKeys& renamed, Problems& problems) {
  rename_in_block(document, renamed.root, both, renamed, problems);
}

}  // namespace pelage
