// SPDX-License-Identifier: Apache-2.0
#include "groom/coat/groom_params.h"

#include <algorithm>

#include "base/nearest_name.h"
#include "groom/operators/follow.h"

namespace pelage {

std::optional<Problem> check_freeze(const GroomParams& params) {
  if (!params.cache) return {};
  const NameReference& freeze = params.cache->freeze;
  const auto& items = params.operators.items;
  std::vector<std::string> names;
  for (const OperatorList::Item& item : items) names.push_back(item.name);
  const auto last = std::find(names.rbegin(), names.rend(), freeze.name);
  if (last == names.rend()) {
    return Problem{freeze.position, "this groom has no operator called " + quote(freeze.name) +
                                        (names.empty() ? "; it has none" : suggest(freeze.name, names))};
  }
  const auto end = items.begin() + (names.rend() - last);
  const auto live = std::find_if(items.begin(), end,
                                 [](const auto& item) { return !item.prototype->traits().reads_rest_only; });
  if (live == end) return {};
  return Problem{freeze.position, quote(live->name) + " runs on posed strands and cannot be frozen" +
                                      (live + 1 == end ? "" : ", and it comes before " + quote(freeze.name))};
}

std::optional<Problem> check_dynamics(const GroomParams& params) {
  if (!params.dynamics) return {};
  const NameReference& after = params.dynamics->after;
  if (!params.strands_file.empty() || params.skin.name.empty()) {
    return Problem{params.strands_file.position,
                   "`dynamics` moves strands that grow on a skin, not those of a strands_file"};
  }
  const auto& items = params.operators.items;
  std::vector<std::string> names;
  for (const OperatorList::Item& item : items) names.push_back(item.name);
  if (!after.name.empty() && std::find(names.begin(), names.end(), after.name) == names.end()) {
    return Problem{after.position, "this groom has no operator called " + quote(after.name) +
                                       (names.empty() ? "; it has none" : suggest(after.name, names))};
  }
  const auto place = static_cast<std::ptrdiff_t>(follow_place(*params.dynamics, params.operators));
  const auto gathers = std::find_if(items.begin() + place, items.end(),
                                    [](const auto& item) { return item.prototype->traits().runs_preceding; });
  if (gathers != items.end()) {
    return Problem{after.position, quote(gathers->name) +
                                       " gathers strands around others as groomed and cannot act on what "
                                       "moved; `after` must name it or an operator behind it"};
  }
  if (!params.cache) return {};
  const auto frozen = std::find(names.rbegin(), names.rend(), params.cache->freeze.name);
  if (names.rend() - frozen <= place) return {};
  return Problem{params.cache->freeze.position,
                 quote(frozen == names.rend() ? "" : *frozen) +
                     " acts on strands that `dynamics` moved and cannot be frozen"};
}

const Schema<GroomCacheParams>& GroomCacheParams::schema() {
  static const Schema<GroomCacheParams> table = [] {
    Schema<GroomCacheParams> s(
        "groom cache",
        "Stores the result of the frozen operators between runs. For each groom, the folder keeps the "
        "results of the eight latest versions of the groom, and of all versions used within the last day. A "
        "result that "
        "is unused for thirty days is deleted when something new is stored. `pelage grow SCENE --prune` "
        "deletes everything that the scene does not need. Different builds of Pelage share stored results "
        "if their source code for growing hair is the same.");
    s.set_example(R"(grooms:
  coat:
    skin: rat
    strands: 400000
    operators:
      - length: {value: 1.2}
      - clump: {spacing: 0.4}
      - frizz: {amplitude: 0.02}
      - width: {root: 0.008, tip: 0.001}
    cache: {directory: cache, freeze: frizz}   # width runs in every frame)");
    s.key("directory", &GroomCacheParams::directory,
          {.help = "Cache folder. Stored results are in files named by a hash of everything that "
                   "determines them. You may delete files at any time, but must not overwrite them while a "
                   "run reads them. Pelage ignores files of other users, except in folders that the "
                   "environment variable PELAGE_SHARED_CACHES names",
           .default_text = "`cache` in the current folder",
           .written = true});
    s.key("freeze", &GroomCacheParams::freeze,
          {.help = "Last frozen operator. It and the operators before it run once, and the result is stored "
                   "with 16 bits per number. If several operators have this name, the last one counts",
           .required = true});
    return s;
  }();
  return table;
}

namespace {

void add_preset_keys(Schema<GroomParams>& s) {
  s.key("preset", &GroomParams::preset,
        {.help = "Coat of an animal, in real measures: rat, mouse, rabbit, cat-short, cat-long, dog-wire, "
                 "fox, horse, panther, polar-bear, sheep, human-straight, human-curly, human-blond or "
                 "human-red. A preset sets the density, the points and the operators, scaled by `units`; "
                 "docs/PRESETS.md lists all values with their sources. Keys of the groom override them. In "
                 "`operators`, the first operator of a name changes the preset's; others follow it. The "
                 "direction of comb, for example, usually needs to be given"});
  s.key("preset_density", &GroomParams::preset_density,
        {.help = "Fraction of the measured density that a preset grows. Strands become thicker where "
                 "necessary, so that the coat covers the skin as well as before",
         .min = 0,
         .max = 1,
         .above_min = true});
}

}  // namespace

const Schema<GroomParams>& GroomParams::schema() {
  static const Schema<GroomParams> table = [] {
    Schema<GroomParams> s("groom",
                          "A coat: where strands grow on a skin, and the operators that shape them.");
    s.set_example(R"(grooms:
  under:
    skin: rat
    role: under
    strands: 400000
    density: {map: maps/density.png, channel: r}
    points: 8
    operators:
      - length: {value: 1.2, variation: 0.3}
      - comb: {direction: [0, -0.3, -1], lift: 0.35}
      - width: {root: 0.008, tip: 0.001}
  whiskers: {strands_file: whiskers.hair, skin: rat, role: whisker})");
    add_preset_keys(s);
    s.key("skin", &GroomParams::skin,
          {.help = "Skin on which the coat grows", .default_text = "none, if strands_file is given"});
    s.key("strands_file", &GroomParams::strands_file,
          {.help = "Strand file (.hair, .tfx, .usda, .abc) in the rest space of the skin. If the groom has a "
                   "skin, each "
                   "strand follows the point of the skin nearest to its root and keeps its distance from "
                   "that point; see `attach`",
           .default_text = "none"});
    s.key("transform", &GroomParams::transform,
          {.help = "From the coordinates of strands_file to the rest space of the skin",
           .default_text = "as in the file"});
    s.key("attach", &GroomParams::attach,
          {.help = "Whether the strands of strands_file follow the skin. `skin`: they follow it. `none`: "
                   "they keep their positions from the file and move only with the character. `auto`: they "
                   "follow the skin, unless at least half of the roots are too far from the skin; then "
                   "Pelage warns and uses `none`. Too far is more than a tenth of the diagonal of the "
                   "skin's bounding box"});
    s.key("basis", &GroomParams::basis,
          {.help = "How control points of strands_file define curves",
           .default_text = "the basis in the file"});
    s.key("default_width", &GroomParams::default_width,
          {.unit = "scene units",
           .help = "Strand diameter if strands_file has none",
           .min = 0,
           .above_min = true,
           .default_text = "none"});
    s.key("role", &GroomParams::role, {.help = "Each role has its own level-of-detail budget, see lod"});
    s.key("strands", &GroomParams::strands,
          {.help = "Number of strands", .min = 1, .max = 5e8, .default_text = "from density"});
    s.key("density", &GroomParams::density,
          {.unit = "1 / square unit",
           .help = "Strands per unit area of the rest skin. If `strands` is given, the density only "
                   "distributes them",
           .min = 0,
           .default_text = "even"});
    s.key("points", &GroomParams::points, {.help = "Control points per strand", .min = 2, .max = 1024});
    s.key("seed", &GroomParams::seed, {.help = "Seed of all random numbers of the groom"});
    s.key("operators", &GroomParams::operators,
          {.help = "Operators that shape the strands, in order. Every strand starts straight and one scene "
                   "unit long"});
    s.key(
        "leaf_strands", &GroomParams::leaf_strands,
        {.help = "Maximum number of strands that grow together, as one chunk; changes no pixel. The "
                 "default is 8000 for coats with a cache. With render.bvh.file, it is 8000 for strands "
                 "from a file and 500 for other coats. In all other cases, Pelage chooses among 8000, "
                 "2000, 500 and 125 (for long strands also 31 and 7). It takes the largest size at which a "
                 "required number of chunks fits into render.memory at once, or the smallest size if no size "
                 "meets this. A control point counts as 80 bytes. The required number is 8 if all fur fits "
                 "into render.memory; otherwise it is 32 for strands from a file and 400 for other coats",
         .min = 1,
         .max = 1e6,
         .default_text = "8000 or less"});
    s.key("cache", &GroomParams::cache,
          {.help = "Stores the result of frozen operators between runs", .default_text = "none"});
    s.key("dynamics", &GroomParams::dynamics,
          {.help = "Moves the coat by the laws of mechanics", .default_text = "strands follow their skin"});
    return s;
  }();
  return table;
}

}  // namespace pelage
