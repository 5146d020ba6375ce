// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "base/vector.h"

namespace pelage {

struct AnimalCoat;

/// A kind of coat, whatever animal wears it. Lengths are fractions of BodyShape::size() or of the strand.
struct CoatLook {
  const char* name;
  const char* help;
  float length;    ///< of the longest strands, fraction of the body
  float coverage;  ///< total area of all strands, seen from the side, divided by the area of the skin
  int strands;     ///< default number
  float lift;      ///< of comb: 0 flat, 1 upright
  float droop;     ///< of comb: how far down hair points, beside 1 towards the tail
  float bend;      ///< degrees by which tips hang down
  float waves;     ///< of noise: displacement of the tip that neighbours share, fraction of the strand
  float clump;     ///< distance between clumps, fraction of the body
  float clumped;   ///< amount of clump
  float frizz;     ///< amplitude, fraction of the strand
  float curl;      ///< radius of curls, fraction of the strand; 0: no curls
  float turns;     ///< of curls
  int points;      ///< control points of a strand
  Rgb root, tip;   ///< colours of a dense coat
  const AnimalCoat* animal = nullptr;  ///< whose hair it is; then `tip` is unused
};

/// The looks that are no animal's; the first is the default.
std::span<const CoatLook> coat_looks();

/// Returns the look, or the coat of the animal (animal_coats()), with this name. Throws Error (kArguments)
/// with the nearest name if there is none.
CoatLook coat_look(const std::string& name);

}  // namespace pelage
