// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/vector.h"

namespace pelage {

/// The fur of an animal, in real measures, from which the keys of the presets of grooms and materials follow.
/// docs/PRESETS.md gives the sources of the numbers, and says which of them are estimates.
struct AnimalCoat {
  const char* name;
  const char* help;
  bool scalp = false;  ///< hair of a human scalp: of the body, it covers BodyShape::scalp only
  float body_mm;       ///< diameter of the sphere with the area of the skin that the hair covers
  float density;       ///< hairs per square centimetre
  float diameter_um;   ///< mean diameter of all hairs at the root, micrometres
  float tip;           ///< diameter of the tip, fraction of the root
  float length_mm;     ///< of the longest hairs
  float variation;     ///< of the length: the shortest hairs lack this fraction
  float lift;          ///< of comb: 0 flat, 1 upright
  float bend;          ///< degrees by which tips hang down
  float waves_mm;      ///< displacement of tips that neighbours share
  float clump_mm;      ///< distance between clumps
  float clumped;       ///< amount of clump
  float frizz_mm;      ///< amplitude
  float curl_mm;       ///< radius of curls; 0: no curls
  float turns;         ///< of curls
  int points;          ///< control points of a hair
  const char* knots;   ///< colour of a dense coat from root to tip, as knots of a ramp; "": by pigments
  Rgb root;            ///< colour of a dense coat near the root, for the skin
  const char* optics;  ///< keys of the material, with its model
};

/// All animals, in the order in which the manual lists them.
std::span<const AnimalCoat> animal_coats();

/// Returns the animal with this name, or nullptr.
const AnimalCoat* find_animal_coat(std::string_view name);

/// The names of all animals, separated by commas.
std::string animal_names();

}  // namespace pelage
