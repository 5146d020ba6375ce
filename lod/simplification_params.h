// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "base/value_readers.h"

namespace pelage {

/// Keys of `render.lod`, which control how many strands of a coat are kept. Each criterion has its own
/// switch.
struct SimplificationParams {
  float quality = 1;
  bool size = true, motion_blur = true, depth_of_field = true, back_facing = true;
  bool width_gain = true, contrast = true, fewer_points = true;
  float guard = 1.5f, under = 1, whisker = 4;
  float blur_strength = 0.75f;
  float min_share = 0.005f;
};

/// Adds these keys to the table of a struct that derives from SimplificationParams.
template <class P>
void add_simplification_keys(Schema<P>& s) {
  using Base = SimplificationParams;
  const auto key = [&s]<class T>(const char* name, T Base::*member, KeyOptions options) {
    s.key(name, static_cast<T P::*>(member), std::move(options));
  };
  key("quality", &Base::quality,
      {.help = "Strands are kept as in a picture of this many times the resolution: 2 keeps about twice as "
               "many",
       .min = 0.01,
       .max = 100});
  key("size", &Base::size, {.help = "Strands that look thinner than a pixel are thinned out"});
  key("motion_blur", &Base::motion_blur, {.help = "More so where they move across the picture"});
  key("depth_of_field", &Base::depth_of_field, {.help = "More so where they are out of focus"});
  key("turned_away", &Base::back_facing,
      {.help =
           "And where the skin is turned away from the camera, down to a fifth: there they are seen past the "
           "edge of the animal at most, and in shadows"});
  key("width_gain", &Base::width_gain,
      {.help = "Those that stay become wider, so that the coat covers as much as before; false only to "
               "measure what that is worth"});
  key("contrast", &Base::contrast,
      {.help = "Colours that vary from strand to strand (`variation` of the operator color) vary less among "
               "fewer strands, so that the coat does not become more speckled"});
  key("fewer_points", &Base::fewer_points,
      {.help = "Strands get fewer control points where that moves them by less than a tenth of a pixel"});
  key("guard", &Base::guard,
      {.help = "How many strands of grooms of the role guard are kept, relative to what their size asks for; "
               "below "
               "1 they are thinned out sooner, but no wider than a pixel",
       .min = 0.01,
       .max = 1000});
  key("under", &Base::under, {.help = "The same for the role under", .min = 0.01, .max = 1000});
  key("whisker", &Base::whisker, {.help = "The same for the role whisker", .min = 0.01, .max = 1000});
  key("blur_strength", &Base::blur_strength,
      {.help = "1 thins blurred coats until as many strands contribute to a pixel as without blur, 0 not at "
               "all",
       .min = 0,
       .max = 1});
  key("least_share", &Base::min_share,
      {.help = "Part of the strands that is always kept", .min = 1e-4, .max = 1});
}

}  // namespace pelage
