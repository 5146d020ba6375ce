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
void warn(const std::string& old_name, const SourcePosition& where, const KeyInfo& key,
          std::vector<Problem>& warnings) {
  const std::string message = quote(old_name) + " is now called " + quote(key.name);
  const bool known = std::any_of(warnings.begin(), warnings.end(), [&](const Problem& problem) {
    return to_string(problem.position) == to_string(where) && problem.message == message;
  });
  if (!known) warnings.push_back({where, message});
}

const KeyInfo* find_only_renamed(const SchemaInfo& table, const std::string& name) {
  return table.find(name) ? nullptr : table.find_renamed(name);
}

void rename_in_block(Value& block, const SchemaInfo& table, RenamedKeys& renamed, Problems& problems) {
  if (!block.is_map()) return;
  std::vector<Value::Entry>& entries = block.entries();
  for (size_t i = 0; i < entries.size(); ++i) {
    const KeyInfo* key = find_only_renamed(table, entries[i].key);
    if (!key) continue;
    warn(entries[i].key, entries[i].key_position, *key, renamed.warnings);
    if (!block.find(key->name)) {
      entries[i].key = key->name;
      continue;
    }
    problems.add(entries[i].key_position, quote(entries[i].key) + " is the old name of " + quote(key->name) +
                                              "; give only one of them");
    entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(i--));
  }
  for (Value::Entry& entry : entries) {
    const KeyInfo* key = table.find(entry.key);
    if (!key) continue;
    key->visit_blocks(entry.value, [&](Value& inner, const SchemaInfo& inner_table) {
      rename_in_block(inner, inner_table, renamed, problems);
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

void rename_old_keys(Value& document, RenamedKeys& renamed, Problems& problems) {
  rename_in_block(document, renamed.root, renamed, problems);
}

RenamedPath::RenamedPath(Value& document, RenamedKeys& renamed)
    : renamed_(renamed), blocks_{{&document, &renamed.root}} {}

const SchemaInfo* RenamedPath::table_of(const Value& block) const {
  const auto known =
      std::find_if(blocks_.begin(), blocks_.end(), [&](const auto& b) { return b.first == &block; });
  return known == blocks_.end() ? nullptr : known->second;
}

std::string RenamedPath::present_name(const Value& block, const std::string& name,
                                      const SourcePosition& where) {
  const SchemaInfo* table = table_of(block);
  const KeyInfo* key = table ? find_only_renamed(*table, name) : nullptr;
  if (!key) return name;
  warn(name, where, *key, renamed_.warnings);
  return key->name;
}

void RenamedPath::enter(const Value& block, const std::string& name, Value& value) {
  const SchemaInfo* table = table_of(block);
  if (!table && !value.is_null()) return;  // a name chosen by the user: the schema's blocks are below it
  blocks_.clear();
  const KeyInfo* key = table ? table->find(name) : nullptr;
  if (!key) return;
  key->visit_blocks(value, [&](Value& inner, const SchemaInfo& inner_table) {
    blocks_.emplace_back(&inner, &inner_table);
  });
}

}  // namespace pelage
