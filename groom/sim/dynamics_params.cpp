// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/dynamics_params.h"

#include <algorithm>

namespace pelage {

namespace {

void add_contact(Schema<DynamicsParams>& s) {
  s.key("friction", &DynamicsParams::friction, {.help = "Friction between strand and skin", .min = 0});
  s.key("collide", &DynamicsParams::collide, {.help = "Whether guides stay outside their skin"});
  s.key(
      "collide_with", &DynamicsParams::collide_with,
      {.help = "Characters whose skins guides stay outside of, as they move. The coat's own character stands "
               "for its other skins"});
  s.key("volume", &DynamicsParams::volume,
        {.unit = "Hz",
         .help = "Keeps a coat from collapsing: a point below its groomed height above the skin is pushed up "
                 "by a spring of this frequency. 0 is off; needs `collide`",
         .min = 0,
         .max = 1000});
}

void add_sway(Schema<DynamicsParams>& s) {
  s.key("sway_frequency", &DynamicsParams::sway_frequency,
        {.unit = "Hz", .help = "How often a guide sways in a second", .min = 0, .above_min = true});
  s.key("sway_damping", &DynamicsParams::sway_damping,
        {.help = "How fast swaying ends: 1 without swaying back, small values slowly, but within two "
                 "seconds at 24 frames per second",
         .min = 0,
         .max = 1});
}

void add_time(Schema<DynamicsParams>& s) {
  s.key("start", &DynamicsParams::start,
        {.help = "First frame that is meant to be seen", .min = -1'000'000, .max = 1'000'000});
  s.key("preroll", &DynamicsParams::preroll,
        {.unit = "frames",
         .help = "The simulation begins this long before `start`, as groomed",
         .min = 0,
         .max = 100000});
}

}  // namespace

size_t DynamicsParams::guide_count(size_t strands) const {
  if (guides) return static_cast<size_t>(*guides);
  return mode == DynamicsMode::kKinematic ? std::clamp<size_t>(strands / 400, 50, 500)
                                          : std::clamp<size_t>(strands / 100, 50, 2000);
}

std::string DynamicsParams::default_guides() const {
  return mode == DynamicsMode::kKinematic ? "one in 400" : "one in a hundred";
}

const Schema<DynamicsParams>& DynamicsParams::schema() {
  static const Schema<DynamicsParams> table = [] {
    Schema<DynamicsParams> s(
        "dynamics",
        "Moves a coat by the laws of mechanics. `pelage simulate` simulates some strands, the guides, as "
        "elastic rods and stores their motion; in every frame, all strands turn like the guides around "
        "them. Without motion of the skin and without wind, the coat stays as it was groomed: gravity is "
        "balanced by the rest shape. All values are in metres, seconds and kilograms; `units` gives the size "
        "of a scene unit. docs/DYNAMICS.md introduces the subject.");
    s.set_example(R"(grooms:
  coat:
    skin: rat
    strands: 20000
    dynamics: {guides: 400, diameter: 60e-6, wind: {velocity: [3, 0, 0], gusts: 0.5}})");
    s.key(
        "mode", &DynamicsParams::mode,
        {.help = "`simulated`: by `pelage simulate`. `kinematic`: guides lag behind their skin and sway like "
                 "damped springs, as `sway_frequency` and `sway_damping` say; all other keys but `guides`, "
                 "`neighbours` and `after` have no effect. Needs no simulation, also for crowds"});
    s.key("files", &DynamicsParams::files,
          {.help = "Strand files with the guides of each frame (.hair, .tfx, .usda, .abc), such as "
                   "`guides.%04d.hair`: the guides follow them and are not simulated. Each file holds the "
                   "guides that `pelage simulate -o` writes, in the same order and in world space. Only "
                   "`guides`, `neighbours` and `after` may be given beside it",
           .default_text = "none"});
    s.key("guides", &DynamicsParams::guides,
          {.help = "Number of strands whose motion is computed: those that level of detail keeps longest",
           .min = 1,
           .max = 100000,
           .default_text = "one strand in 100, from 50 to 2000; `kinematic`: one in 400, from 50 to 500"});
    s.key("neighbours", &DynamicsParams::neighbours,
          {.help = "Number of guides that turn a strand", .min = 1, .max = 8});
    s.key("after", &DynamicsParams::after,
          {.help = "Operator after which strands move; the operators behind it act on what moved. If several "
                   "operators have this name, the last one counts",
           .default_text = "the last operator before `push_out`"});
    s.key("density", &DynamicsParams::density,
          {.unit = "kg / m^3", .help = "Density of a strand; keratin has 1300", .min = 0, .above_min = true});
    s.key("youngs_modulus", &DynamicsParams::youngs_modulus,
          {.unit = "Pa",
           .help = "Stiffness of a strand; dry hair has 3e9 to 5e9, wet hair 1e9",
           .min = 0,
           .above_min = true});
    s.key("diameter", &DynamicsParams::diameter,
          {.unit = "m",
           .help = "Diameter of a strand. Stiffness grows with its fourth power, weight with its square",
           .min = 0,
           .above_min = true,
           .default_text = "as groomed, at the middle of each guide"});
    s.key("damping", &DynamicsParams::damping,
          {.unit = "s",
           .help = "Inner friction: bending resists its rate of change by this many times its stiffness",
           .min = 0});
    s.key("drag", &DynamicsParams::drag,
          {.unit = "Pa s",
           .help = "Force of the air per length of a strand and velocity of the air; a thin strand has about "
                   "1e-4",
           .min = 0});
    add_contact(s);
    s.key("gravity", &DynamicsParams::gravity, {.unit = "m / s^2", .help = "Acceleration by gravity"});
    s.key("wind", &DynamicsParams::wind, {.help = "The air", .default_text = "still air"});
    s.key("substeps", &DynamicsParams::substeps,
          {.help = "Steps per frame, rounded up to an even number. More are slower and damp less",
           .min = 2,
           .max = 1000});
    add_sway(s);
    add_time(s);
    s.key("directory", &DynamicsParams::directory,
          {.help = "Folder of the stored motion, one file per frame. You may delete files at any time",
           .default_text = "`cache` in the current folder",
           .written = true});
    return s;
  }();
  return table;
}

}  // namespace pelage
