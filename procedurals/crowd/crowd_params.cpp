// SPDX-License-Identifier: Apache-2.0
#include "procedurals/crowd/crowd.h"

namespace pelage {

namespace {

// Max fraction by which an animal may shrink.
constexpr double kMaxVariation = 0.95;

}  // namespace

const Schema<CrowdHeadingParams>& CrowdHeadingParams::schema() {
  static const Schema<CrowdHeadingParams> table = [] {
    Schema<CrowdHeadingParams> s("heading", "The direction in which the animals of a crowd face.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: disc, radius: 80}
    heading: {value: 90, variation: 20})");
    s.key("value", &CrowdHeadingParams::value,
          {.unit = "degrees", .help = "Rotation about y; 0 keeps the direction of the character"});
    s.key("variation", &CrowdHeadingParams::variation,
          {.unit = "degrees",
           .help = "Maximum random rotation to either side; 180 gives any direction",
           .min = 0,
           .max = 180});
    return s;
  }();
  return table;
}

const Schema<CrowdPhaseParams>& CrowdPhaseParams::schema() {
  static const Schema<CrowdPhaseParams> table = [] {
    Schema<CrowdPhaseParams> s("phase", "Frames added to the current frame to choose each animal's pose.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: disc, radius: 80}
    phase: {variation: 6}   # half of a cycle of 12 frames)");
    s.key("value", &CrowdPhaseParams::value,
          {.unit = "frames", .help = "Offset of all animals; may be fractional"});
    s.key("variation", &CrowdPhaseParams::variation,
          {.unit = "frames",
           .help = "Maximum random offset to either side; half a cycle gives any pose of the cycle",
           .min = 0});
    return s;
  }();
  return table;
}

const Schema<CrowdScaleParams>& CrowdScaleParams::schema() {
  static const Schema<CrowdScaleParams> table = [] {
    Schema<CrowdScaleParams> s("crowd scale", "The size of the animals of a crowd.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: disc, radius: 80}
    scale: {variation: 0.1, axes: [0.05, 0.05, 0.05]})");
    s.key("value", &CrowdScaleParams::value, {.help = "Scale of all animals", .min = 0, .above_min = true});
    s.key("variation", &CrowdScaleParams::variation,
          {.help = "Maximum random change of the scale: 0.2 gives 80 to 120 %",
           .min = 0,
           .max = kMaxVariation});
    s.key("axes", &CrowdScaleParams::axes,
          {.help = "Maximum random changes of width, height and length, independently",
           .min = 0,
           .max = kMaxVariation});
    return s;
  }();
  return table;
}

const Schema<CrowdLengthParams>& CrowdLengthParams::schema() {
  static const Schema<CrowdLengthParams> table = [] {
    Schema<CrowdLengthParams> s("hair length", "The hair length of the animals of a crowd.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: disc, radius: 80}
    length: {variation: 0.2})");
    s.key("value", &CrowdLengthParams::value,
          {.help = "Factor on the hair length of all animals", .min = 0, .above_min = true});
    s.key("variation", &CrowdLengthParams::variation,
          {.help = "Maximum random change of the hair length: 0.2 gives 80 to 120 %",
           .min = 0,
           .max = kMaxVariation});
    return s;
  }();
  return table;
}

const Schema<CrowdColorParams>& CrowdColorParams::schema() {
  static const Schema<CrowdColorParams> table = [] {
    Schema<CrowdColorParams> s("crowd color", "Factors on the colours of hair and skins in a crowd.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: disc, radius: 80}
    color: {variation: 0.25, hue: 0.05})");
    s.key("value", &CrowdColorParams::value, {.help = "Factor for all animals", .min = 0});
    s.key("variation", &CrowdColorParams::variation,
          {.help = "Maximum random change of brightness: 0.2 gives 80 to 120 %", .min = 0, .max = 1});
    s.key("hue", &CrowdColorParams::hue,
          {.help = "Maximum random changes of red, green and blue, independently", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

const Schema<CrowdParams>& CrowdParams::schema() {
  static const Schema<CrowdParams> table = [] {
    Schema<CrowdParams> s(
        "crowd",
        "Many animals from a few characters. Each has its own pose, size, hair length and colour. Pelage "
        "spreads them evenly over an area and pushes apart animals that are too close; a crowd also keeps "
        "clear of the crowds listed before it in the scene. Every random number depends on the seed and "
        "the name of the crowd, not on the frame. A character in `of` does not appear by itself, unless it "
        "has `drawn: true`.");
    s.set_example(R"(crowds:
  herd:
    of: [rat]
    count: 200
    area: {type: rectangle, size: [200, 120]}
    spacing: 2
    heading: {value: 0, variation: 40}
    scale: {variation: 0.1})");
    s.key("of", &CrowdParams::of,
          {.help = "Names of characters; each animal is a random one of them", .required = true});
    s.key("count", &CrowdParams::count,
          {.help = "Number of animals. If they do not fit into the area, Pelage stops with an error",
           .required = true,
           .min = 1,
           .max = 1e6});
    s.key("seed", &CrowdParams::seed, {.help = "Seed of all random numbers of the crowd"});
    s.key("area", &CrowdParams::area,
          {.help = "Area that holds the origins of the animals", .required = true});
    s.key("spacing", &CrowdParams::spacing,
          {.unit = "scene units",
           .help = "Minimum distance between footprints, or between origins if characters have no footprint",
           .min = 0});
    s.key(
        "ground", &CrowdParams::ground,
        {.help = "Character on whose skins the animals stand, instead of level ground: each is moved along y "
                 "to the highest point. It must neither move nor have poses",
         .default_text = "level"});
    s.key("tilt", &CrowdParams::tilt,
          {.help = "How far animals lean with the slope of `ground`: 0 upright, 1 along its normal",
           .min = 0,
           .max = 1});
    s.key("heading", &CrowdParams::heading,
          {.help = "Direction in which the animals face", .default_text = "any direction"});
    s.key("phase", &CrowdParams::phase,
          {.help = "Pose of each animal", .default_text = "the pose of the frame"});
    s.key("scale", &CrowdParams::scale, {.help = "Size of the animals", .default_text = "1"});
    s.key("length", &CrowdParams::length, {.help = "Hair length of the animals", .default_text = "1"});
    s.key("color", &CrowdParams::color, {.help = "Colour of the animals", .default_text = "1"});
    return s;
  }();
  return table;
}

}  // namespace pelage
