// SPDX-License-Identifier: Apache-2.0
#include "starter/coat_look.h"

#include <vector>

#include "base/error.h"
#include "base/nearest_name.h"
#include "starter/animal_preset.h"

namespace pelage {
namespace {

// Real coats have a hundred times as many strands, each a fifth to a tenth as wide: the looks keep the
// coverage of the skin, and the length in proportion to the body. docs/lab/STARTER.md says how the numbers
// were found.
constexpr CoatLook kLooks[] = {
    {.name = "plush",
     .help = "dense and soft, of medium length, like a cat or a rabbit",
     .length = 0.09f,
     .coverage = 9,
     .strands = 250000,
     .lift = 0.4f,
     .droop = 0.45f,
     .bend = 15,
     .waves = 0.25f,
     .clump = 0.045f,
     .clumped = 0.45f,
     .frizz = 0.05f,
     .curl = 0,
     .turns = 0,
     .points = 7,
     .root = {0.13f, 0.075f, 0.045f},
     .tip = {0.52f, 0.34f, 0.19f}},
    {.name = "short",
     .help = "sleek and close to the body, like a cow or a horse",
     .length = 0.045f,
     .coverage = 6,
     .strands = 350000,
     .lift = 0.25f,
     .droop = 0.5f,
     .bend = 0,
     .waves = 0.2f,
     .clump = 0.03f,
     .clumped = 0.3f,
     .frizz = 0.03f,
     .curl = 0,
     .turns = 0,
     .points = 5,
     .root = {0.16f, 0.06f, 0.025f},
     .tip = {0.40f, 0.17f, 0.07f}},
    {.name = "long",
     .help = "long and hanging, like a Highland cow or a Persian cat",
     .length = 0.24f,
     .coverage = 12,
     .strands = 200000,
     .lift = 0.3f,
     .droop = 0.8f,
     .bend = 45,
     .waves = 0.22f,
     .clump = 0.06f,
     .clumped = 0.55f,
     .frizz = 0.03f,
     .curl = 0,
     .turns = 0,
     .points = 10,
     .root = {0.22f, 0.09f, 0.03f},
     .tip = {0.66f, 0.33f, 0.12f}},
    {.name = "woolly",
     .help = "tight curls that hold together, like a sheep or a poodle",
     .length = 0.10f,
     .coverage = 10,
     .strands = 200000,
     .lift = 0.75f,
     .droop = 0.5f,
     .bend = 10,
     .waves = 0.3f,
     .clump = 0.035f,
     .clumped = 0.6f,
     .frizz = 0.05f,
     .curl = 0.09f,
     .turns = 2.5f,
     .points = 16,
     .root = {0.50f, 0.43f, 0.34f},
     .tip = {0.74f, 0.68f, 0.58f}},
    {.name = "wiry",
     .help = "coarse, rough and tousled, like a terrier or a boar",
     .length = 0.085f,
     .coverage = 7,
     .strands = 150000,
     .lift = 0.45f,
     .droop = 0.5f,
     .bend = 10,
     .waves = 0.4f,
     .clump = 0.04f,
     .clumped = 0.35f,
     .frizz = 0.1f,
     .curl = 0,
     .turns = 0,
     .points = 8,
     .root = {0.07f, 0.06f, 0.055f},
     .tip = {0.36f, 0.31f, 0.25f}},
};

}  // namespace

std::span<const CoatLook> coat_looks() { return kLooks; }

CoatLook coat_look(const std::string& name) {
  std::vector<std::string> names;
  for (const CoatLook& look : kLooks) {
    if (look.name == name) return look;
    names.emplace_back(look.name);
  }
  for (const AnimalCoat& animal : animal_coats()) {
    if (animal.name == name) return proportional_look(animal);
    names.emplace_back(animal.name);
  }
  throw Error(ErrorKind::kArguments, "--preset " + quote(name) + " is not known" + suggest(name, names));
}

}  // namespace pelage
