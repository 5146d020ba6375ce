// SPDX-License-Identifier: Apache-2.0
#include "scene/overrides.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/nearest_name.h"
#include "scene/renamed_keys.h"

namespace pelage {
namespace {

std::vector<std::string> split(const std::string& key) {
  std::vector<std::string> names;
  size_t start = 0;
  while (true) {
    const size_t dot = key.find('.', start);
    names.push_back(key.substr(start, dot - start));
    if (dot == std::string::npos) return names;
    start = dot + 1;
  }
}

std::string given_name(const Value& item) {
  if (!item.is_map() || item.entries().size() != 1) return {};
  const Value* name = item.entries()[0].value.find("name");
  return name && name->is_scalar() ? name->text() : std::string();
}

std::string only_key(const Value& item) {
  return item.is_map() && item.entries().size() == 1 ? item.entries()[0].key : std::string();
}

// Finds an item of a list. For an index, returns the item itself; for a name, the value under the item's
// single key.
Value* find_item(Value& list, const std::string& name, const SourcePosition& where, Problems& problems) {
  std::vector<Value>& items = list.items();
  size_t index = 0;
  const char* end = name.data() + name.size();
  if (const auto [rest, error] = std::from_chars(name.data(), end, index);
      error == std::errc() && rest == end) {
    if (index < items.size()) return &items[index];
    problems.add(where, "no item " + name + " in a list of " + std::to_string(items.size()) +
                            (items.empty() ? "" : " (the first is 0)"));
    return nullptr;
  }
  std::vector<std::string> names;
  std::vector<size_t> found;
  for (size_t i = 0; i < items.size(); ++i) {
    const std::string key = only_key(items[i]);
    const std::string given = given_name(items[i]);
    if (name == key || name == given) found.push_back(i);
    if (!key.empty()) names.push_back(key);
    if (!given.empty()) names.push_back(given);
  }
  if (found.size() == 1) return &items[found[0]].entries()[0].value;
  if (found.empty()) {
    problems.add(where, "no item " + quote(name) + " in the list" + suggest(name, names));
  } else {
    std::string message = quote(name) + " is the name of several items of the list; use an index:";
    for (const size_t i : found) message += " " + std::to_string(i);
    problems.add(where, std::move(message));
  }
  return nullptr;
}

// Suggests sub-blocks with similar names: a path through a missing block is more likely a typo than a new
// block.
std::string near_block(const Value& block, const std::string& name) {
  std::vector<std::string> blocks;
  for (const Value::Entry& entry : block.entries()) {
    if (entry.value.is_map() || entry.value.is_list()) blocks.push_back(entry.key);
  }
  return did_you_mean(name, blocks);
}

// The value under a name, created if missing. `leads_on`: more names follow.
Value* find_entry(Value& block, const std::string& name, bool leads_on, const SourcePosition& where,
                  Problems& problems) {
  if (block.is_null()) block = Value::map(where, {});
  if (!block.is_map()) {
    problems.add(where,
                 "cannot look up " + quote(name) + " in " + block.describe() + ", which is not a block");
    return nullptr;
  }
  if (Value* value = block.find(name)) return value;
  if (const std::string near = leads_on ? near_block(block, name) : ""; !near.empty()) {
    problems.add(where, "no block " + quote(name) + near + " (to add a new block, give it whole, as " + name +
                            "={...})");
    return nullptr;
  }
  block.entries().push_back({name, where, Value()});
  block.entries().back().value.set_position(where);
  return &block.entries().back().value;
}

// Removes the item of a list that find_item() has found.
void remove_item(Value& list, const Value& found) {
  std::erase_if(list.items(), [&](const Value& item) {
    return &item == &found || (!only_key(item).empty() && &item.entries()[0].value == &found);
  });
}

// Removes the entry of a name. Returns whether this is settled: if there is neither such an entry nor a
// similar one, the schema decides whether the name may have no value.
bool remove_entry(Value& block, const std::string& name, const SourcePosition& where, Problems& problems) {
  if (!block.is_map()) return false;
  const auto is_named = [&](const Value::Entry& entry) { return entry.key == name; };
  if (std::erase_if(block.entries(), is_named) > 0) return true;
  std::vector<std::string> names;
  for (const Value::Entry& entry : block.entries()) names.push_back(entry.key);
  const std::string near = did_you_mean(name, names);
  if (!near.empty()) problems.add(where, "no " + quote(name) + " to remove" + near);
  return !near.empty();
}

}  // namespace

void apply_override(const Override& override, Value& document, DocumentLimits& limits, Problems& problems,
                    RenamedKeys* renamed) {
  const SourcePosition where{(override.given ? "" : "--set ") + override.key, 0, 0};
  const std::vector<std::string> names = split(override.key);
  if (std::any_of(names.begin(), names.end(), [](const std::string& name) { return name.empty(); })) {
    problems.add(where, "expected names separated by single dots");
    return;
  }
  std::optional<Value> value = override.given;
  if (!value) value = read_yaml(override.value, where.file, where, limits, problems);
  if (!value) return;
  value->set_position(where);
  // `--set key=` is more likely a mistake than a wish to remove the key.
  const bool is_removal = value->is_null() && (override.given || !override.value.empty());
  std::optional<RenamedPath> path;
  if (renamed) path.emplace(document, *renamed);
  Value* target = &document;
  for (size_t i = 0; i < names.size() && target; ++i) {
    Value& block = *target;
    const bool removes = is_removal && i + 1 == names.size();
    if (block.is_list()) {
      target = find_item(block, names[i], where, problems);
      if (removes && target) return remove_item(block, *target);
      continue;
    }
    const std::string name = path ? path->present_name(block, names[i], where) : names[i];
    if (removes && remove_entry(block, name, where, problems)) return;
    target = find_entry(block, name, i + 1 < names.size(), where, problems);
    if (path && target) path->enter(block, name, *target);
  }
  if (target) *target = std::move(*value);
}

}  // namespace pelage
