// SPDX-License-Identifier: Apache-2.0
#include "world/scene_source.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "rib/document/rib_document.h"
#include "scene/overrides.h"
#include "scene/renamed_keys.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

/// The value of `render.memory` before it is checked; the default without one. 0 means no limit.
size_t memory_of(const std::string& text) {
  const size_t bytes = parse_bytes(text).value_or(RenderParams().memory.bytes);
  return bytes > 0 ? bytes : std::numeric_limits<size_t>::max();
}

/// Removes the folders that Pelage would write into from values that come from RIB files or tables of
/// materials, with a warning for each: a file of a stranger must not decide where files appear. The user can
/// name such folders on the command line.
void drop_folders(Value& block, const SchemaInfo& schema, bool only_overrides,
                  std::vector<Problem>& warnings) {
  std::erase_if(block.entries(), [&](Value::Entry& entry) {
    const KeyInfo* key = schema.find(entry.key);
    if (!key) return false;
    key->visit_blocks(entry.value, [&](Value& inner, const SchemaInfo& of) {
      drop_folders(inner, of, only_overrides, warnings);
    });
    if (!key->options.written || (only_overrides && entry.value.position().line > 0)) return false;
    warnings.push_back(
        {entry.value.position(),
         fmt::format("`{}` is ignored: RIB files and tables of materials must not name folders "
                     "to write into; --set can",
                     entry.key)});
    return true;
  });
}

/// Adds the materials of the RIB files that a scene names as archives.
void add_foreign_materials(Value& document, const RibUse& use, std::vector<Problem>& warnings) {
  const Value* render = document.find("render");
  const Value* memory = render ? render->find("memory") : nullptr;
  const Value* materials = document.find("materials");
  const size_t own = materials ? materials->entries().size() : 0;
  add_archive_materials(document, use, memory_of(memory ? memory->text() : ""), warnings);
  Value* all = document.find("materials");
  if (!all) return;
  Value added = Value::map(all->position(), {});
  auto& entries = all->entries();
  const auto first = entries.begin() + static_cast<std::ptrdiff_t>(std::min(own, entries.size()));
  std::move(first, entries.end(), std::back_inserter(added.entries()));
  entries.erase(first, entries.end());
  SceneDescription::schema()
      .find("materials")
      ->visit_blocks(added, [&](Value& block, const SchemaInfo& schema) {
        drop_folders(block, schema, false, warnings);
      });
  std::move(added.entries().begin(), added.entries().end(), std::back_inserter(entries));
}

}  // namespace

bool SceneSource::is_rib() const { return !made && pelage::is_rib(path); }

std::optional<Value> SceneSource::any_document(const std::vector<Override>& overrides, const RibUse& use,
                                               Problems& problems, RenamedKeys& renamed) const {
  if (!is_rib()) {
    std::optional<Value> document = this->document(overrides, problems, &renamed);
    if (document && use.overrides)
      drop_folders(*document, SceneDescription::schema(), true, renamed.warnings);
    if (document) add_foreign_materials(*document, use, renamed.warnings);
    return document;
  }
  std::string memory;
  for (const Override& override : overrides) {
    if (override.key == "render.memory") memory = override.given ? override.given->text() : override.value;
  }
  Value document = rib_document(path, use, memory_of(memory), renamed.warnings);
  rename_old_keys(document, renamed, problems);
  drop_folders(document, SceneDescription::schema(), false, renamed.warnings);
  DocumentLimits limits;
  for (const Override& override : overrides) {
    apply_override(override, document, limits, problems, &renamed);
    rename_old_keys(document, renamed, problems);
  }
  return document;
}

}  // namespace pelage
