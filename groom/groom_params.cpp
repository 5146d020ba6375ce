// SPDX-License-Identifier: Apache-2.0
// Tested in tests/groom/groom_test.cpp.
#include "groom/groom_params.h"

#include <algorithm>

#include "base/nearest_name.h"

namespace pelage {

std::optional<Problem> check_freeze(const GroomParams& params) {
  if (!params.cache) return {};
  const NameReference& freeze = params.cache->freeze;
  const auto& items = params.operators.items;
  std::vector<std::string> names;
  for (const OperatorList::Item& item : items) names.push_back(item.name);
  const auto last = std::find(names.rbegin(), names.rend(), freeze.name);
  if (last == names.rend()) {
    return Problem{freeze.position, "no operator of this groom is called " + quote(freeze.name) +
                                        (names.empty() ? "; it has none" : suggest(freeze.name, names))};
  }
  const auto end = items.begin() + (names.rend() - last);
  const auto live =
      std::find_if(items.begin(), end, [](const auto& item) { return !item.prototype->reads_rest_only(); });
  if (live == end) return {};
  return Problem{freeze.position,
                 quote(live->name) + " works on posed strands and cannot be frozen" +
                     (live + 1 == end ? "" : ", and it stands before " + quote(freeze.name))};
}

const Schema<GroomCacheParams>& GroomCacheParams::schema() {
  static const Schema<GroomCacheParams> table = [] {
    Schema<GroomCacheParams> s("groom cache",
                               "Where what the frozen operators do is kept between runs. Of each groom the "
                               "folder keeps the last eight "
                               "states and those used within a day; what nothing has used for thirty days "
                               "goes when something is stored. "
                               "`pelage grow SCENE --prune` removes all that the scene does not need. "
                               "Programs whose growth is built from "
                               "the same sources share a folder.");
    s.key("directory", &GroomCacheParams::directory,
          {.help = "Folder; files in it are named by what they were made from, and may be removed at any "
                   "time, but not written over while a run reads them. Files of other users count as absent, "
                   "except in folders that the environment variable PELAGE_SHARED_CACHES names",
           .default_text = "cache, in the current folder"});
    s.key(
        "freeze", &GroomCacheParams::freeze,
        {.help = "Last operator that is frozen: it and those before it run once, and their result is kept in "
                 "16 bits; of several with this name, the last",
         .required = true});
    return s;
  }();
  return table;
}

const Schema<GroomParams>& GroomParams::schema() {
  static const Schema<GroomParams> table = [] {
    Schema<GroomParams> s("groom", "A coat: where strands grow on a skin and the operators that shape them.");
    s.key("skin", &GroomParams::skin,
          {.help = "Skin that it grows on", .default_text = "none: strands_file alone"});
    s.key("strands_file", &GroomParams::strands_file,
          {.help = "Strands made elsewhere (.hair, .tfx), in the rest space of the skin. On a skin "
                   "each follows the nearest point of it and keeps its distance, see attach",
           .default_text = "none"});
    s.key(
        "attach", &GroomParams::attach,
        {.help = "Whether the strands of strands_file follow the skin. skin: they do. none: they stay where "
                 "the file puts them and move with the character alone, as without a skin. auto: they "
                 "follow the skin, unless half of them begin farther from it than a tenth of its "
                 "diagonal; then as none, with a warning"});
    s.key("basis", &GroomParams::basis,
          {.help = "What the points of strands_file mean", .default_text = "what the file says"});
    s.key("default_width", &GroomParams::default_width,
          {.unit = "scene units",
           .help = "Diameter where strands_file has none",
           .min = 0,
           .above_min = true,
           .default_text = "none"});
    s.key("role", &GroomParams::role, {.help = "Each role has a budget of its own when detail is reduced"});
    s.key("strands", &GroomParams::strands,
          {.help = "How many strands", .min = 1, .max = 5e8, .default_text = "what the density says"});
    s.key("density", &GroomParams::density,
          {.unit = "1 / square unit",
           .help = "Strands per area of the rest skin; beside `strands` only its proportions count",
           .min = 0,
           .default_text = "even"});
    s.key("points", &GroomParams::points, {.help = "Control points of a strand", .min = 2, .max = 1024});
    s.key("seed", &GroomParams::seed, {.help = "Changes all random numbers of the groom"});
    s.key("operators", &GroomParams::operators,
          {.help =
               "What shapes the strands, in this order; every strand begins straight, one scene unit long"});
    s.key(
        "leaf_strands", &GroomParams::leaf_strands,
        {.help =
             "Most strands that are grown together; changes no pixel. By default 500 with "
             "render.bvh.file; else 8000 or 2000, 500, 125 (of long strands 31 or 7), so few that 400 chunks "
             "of "
             "80 bytes a control point (of a file 32, and 8 where all fur fits) fit render.memory; 8000 for "
             "coats with a cache",
         .min = 1,
         .max = 1e6,
         .default_text = "8000 or fewer"});
    s.key("cache", &GroomParams::cache, {.help = "Keeps what frozen operators do", .default_text = "none"});
    return s;
  }();
  return table;
}

}  // namespace pelage
