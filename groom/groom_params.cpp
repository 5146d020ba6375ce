// SPDX-License-Identifier: Apache-2.0
#include "groom/groom_params.h"

namespace pelage {

const Schema<GroomCacheParams>& GroomCacheParams::schema() {
  static const Schema<GroomCacheParams> table = [] {
    Schema<GroomCacheParams> s("groom cache", "Where what the frozen operators do is kept between runs.");
    s.key("directory", &GroomCacheParams::directory, {.help = "Folder; files are named by content"});
    s.key("freeze", &GroomCacheParams::freeze, {.help = "Last operator that is frozen", .required = true});
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
          {.help = "Strands made elsewhere (.hair, .tfx), in the rest space of the skin; on a skin each "
                   "follows the "
                   "nearest point of it",
           .default_text = "none"});
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
    s.key("leaf_strands", &GroomParams::leaf_strands,
          {.help = "Most strands that are grown together; changes no pixel", .min = 1, .max = 1e6});
    s.key("cache", &GroomParams::cache, {.help = "Keeps what frozen operators do", .default_text = "none"});
    return s;
  }();
  return table;
}

}  // namespace pelage
