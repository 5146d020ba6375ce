// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "base/value_readers.h"

namespace pelage {

/// Values of the keys of `render.lod`, which control how many strands of a coat are kept. See
/// add_simplification_keys() for their meaning. Each criterion can be turned off separately.
struct SimplificationParams {
  float quality = 1;
  bool size = true, motion_blur = true, depth_of_field = true, back_facing = true;
  bool width_gain = true, contrast = true, fewer_points = true;
  float guard = 1.5f, under = 1, whisker = 4;
  float blur_strength = 0.75f;
  float min_share = 0.005f;
};

/// Adds the keys of SimplificationParams to the table of a struct that derives from it.
template <class P>
void add_simplification_keys(Schema<P>& s) {
  using Base = SimplificationParams;
  const auto key = [&s]<class T>(const char* name, T Base::*member, const KeyOptions& options) {
    s.key(name, static_cast<T P::*>(member), options);
  };
  key("quality", &Base::quality,
      {.help = "Factor on the resolution for which strands are kept: 2 keeps the strands that a picture of "
               "twice the resolution needs, about twice as many",
       .min = 0.01,
       .max = 100});
  key("size", &Base::size, {.help = "Thins out strands that are narrower than a pixel"});
  key("motion_blur", &Base::motion_blur, {.help = "Thins out strands further where motion blurs them"});
  key("depth_of_field", &Base::depth_of_field,
      {.help = "Thins out strands further where they are out of focus"});
  key("backfacing", &Base::back_facing,
      {.help = "Thins out strands further, down to a fifth, where the skin faces away from the camera. Such "
               "strands are visible only past the silhouette and in shadows",
       .old_names = {"turned_away"}});
  key("width_gain", &Base::width_gain,
      {.help = "Widens the remaining strands so that the coat keeps its coverage. Set it to false only to "
               "measure its effect"});
  key("contrast", &Base::contrast,
      {.help = "Reduces the colour variation between strands (`variation` of the operator color) where fewer "
               "strands remain, so that the coat does not become more speckled"});
  key("fewer_points", &Base::fewer_points,
      {.help = "Removes control points of a strand where this moves it by less than a tenth of a pixel"});
  key("guard", &Base::guard,
      {.help = "Factor on the number of strands that grooms of role guard keep. Values below 1 keep fewer "
               "strands, but never so few that the widened strands would be wider than a pixel",
       .min = 0.01,
       .max = 1000});
  key("under", &Base::under, {.help = "The same factor for role under", .min = 0.01, .max = 1000});
  key("whisker", &Base::whisker, {.help = "The same factor for role whisker", .min = 0.01, .max = 1000});
  key("blur_strength", &Base::blur_strength,
      {.help =
           "How strongly blur thins out a coat. Blur increases the number of strands that contribute to a "
           "pixel. 1: strands are removed until this number is the same as without blur; 0: blur removes no "
           "strands",
       .min = 0,
       .max = 1});
  key("min_fraction", &Base::min_share,
      {.help = "Minimum fraction of the strands to keep",
       .min = 1e-4,
       .max = 1,
       .old_names = {"least_share"}});
}

}  // namespace pelage
