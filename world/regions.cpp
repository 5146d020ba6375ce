// SPDX-License-Identifier: Apache-2.0
#include "world/regions.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/nearest_name.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

constexpr size_t kMaxDepth = 32, kMaxValues = 100000;

size_t count_values(const Value& value) {
  size_t count = 1;
  for (const Value& item : value.items()) count += count_values(item);
  for (const Value::Entry& entry : value.entries()) count += count_values(entry.value);
  return count;
}

class RegionExpander {
 public:
  /// Keeps a copy of the regions, because the document changes.
  RegionExpander(const Value& document, Problems& problems) : problems_(problems) {
    if (const Value* regions = document.find("regions"); regions && regions->is_map()) regions_ = *regions;
    for (const Value::Entry& entry : regions_.entries()) names_.push_back(entry.key);
  }

  void expand(Value& block, const SchemaInfo& table) {
    if (table.name() == "region field") return resolve(block);
    for (Value::Entry& entry : block.entries()) {
      if (const KeyInfo* key = table.find(entry.key))
        key->visit_blocks(entry.value, [&](Value& inner, const SchemaInfo& of) { expand(inner, of); });
    }
  }

 private:
  void resolve(Value& block) {
    Value* name = block.find("region");
    // The reader of fields reports a malformed block.
    if (!name || !name->is_scalar() || name->text().empty() || block.entries().size() != 1) return;
    const std::string region = name->text();
    const Value* definition = regions_.find(region);
    if (!definition) {
      return refuse(*name, "there is no region " + quote(region) +
                               (names_.empty() ? "; the scene has none" : suggest(region, names_)));
    }
    if (broken_.contains(region)) return refuse(*name, "");
    if (std::find(path_.begin(), path_.end(), region) != path_.end()) {
      broken_.insert(path_.begin(), path_.end());
      return refuse(*name, "the region " + quote(region) + " is defined by itself");
    }
    values_ += count_values(*definition);
    if (path_.size() >= kMaxDepth || values_ > kMaxValues) {
      broken_.insert(names_.begin(), names_.end());
      return refuse(*name, path_.size() >= kMaxDepth
                               ? "regions are nested more than 32 deep"
                               : "the regions are too large when they are put together");
    }
    Value field = *definition;
    path_.push_back(region);
    ValueReader<Field>::visit_blocks(field,
                                     [&](Value& inner, const SchemaInfo& table) { expand(inner, table); });
    path_.pop_back();
    block = std::move(field);
  }

  void refuse(Value& name, const std::string& why) {
    if (!why.empty()) problems_.add(name.position(), why);
    name = Value::scalar(name.position(), "");
  }

  Value regions_;
  std::vector<std::string> names_;
  std::vector<std::string> path_;  // regions that are being expanded
  std::set<std::string> broken_;   // reported as part of a circle, or too large
  size_t values_ = 0;
  Problems& problems_;
};

}  // namespace

void expand_regions(Value& document, Problems& problems) {
  RegionExpander(document, problems).expand(document, SceneDescription::schema());
}

}  // namespace pelage
