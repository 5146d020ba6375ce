// SPDX-License-Identifier: Apache-2.0
// Tested in tests/procedurals/crowd_test.cpp.
#include "procedurals/crowd.h"

namespace pelage {

namespace {

// A share that an animal may lose without vanishing.
constexpr double kMaxVariation = 0.95;

}  // namespace

const Schema<CrowdHeadingParams>& CrowdHeadingParams::schema() {
  static const Schema<CrowdHeadingParams> table = [] {
    Schema<CrowdHeadingParams> s("heading", "Which way the animals of a crowd look.");
    s.key("value", &CrowdHeadingParams::value,
          {.unit = "degrees", .help = "About y: 0 is the way the character looks by itself"});
    s.key("variation", &CrowdHeadingParams::variation,
          {.unit = "degrees", .help = "Farthest to either side; 180 is any way", .min = 0, .max = 180});
    return s;
  }();
  return table;
}

const Schema<CrowdPhaseParams>& CrowdPhaseParams::schema() {
  static const Schema<CrowdPhaseParams> table = [] {
    Schema<CrowdPhaseParams> s("phase", "What is added to the frame to choose each animal's pose.");
    s.key("value", &CrowdPhaseParams::value, {.unit = "frames", .help = "Of all; may be a fraction"});
    s.key("variation", &CrowdPhaseParams::variation,
          {.unit = "frames", .help = "Farthest to either side; half of a cycle is any pose of it", .min = 0});
    return s;
  }();
  return table;
}

const Schema<CrowdScaleParams>& CrowdScaleParams::schema() {
  static const Schema<CrowdScaleParams> table = [] {
    Schema<CrowdScaleParams> s("crowd scale", "How large the animals of a crowd are.");
    s.key("value", &CrowdScaleParams::value, {.help = "Of all", .min = 0, .above_min = true});
    s.key("variation", &CrowdScaleParams::variation,
          {.help = "Most that one is larger or smaller, as a share", .min = 0, .max = kMaxVariation});
    s.key("axes", &CrowdScaleParams::axes,
          {.help = "The same for width, height and length by themselves", .min = 0, .max = kMaxVariation});
    return s;
  }();
  return table;
}

const Schema<CrowdLengthParams>& CrowdLengthParams::schema() {
  static const Schema<CrowdLengthParams> table = [] {
    Schema<CrowdLengthParams> s("hair length", "How long the hair of the animals of a crowd is.");
    s.key("value", &CrowdLengthParams::value,
          {.help = "Times what the groom makes", .min = 0, .above_min = true});
    s.key("variation", &CrowdLengthParams::variation,
          {.help = "Most that one's is longer or shorter, as a share", .min = 0, .max = kMaxVariation});
    return s;
  }();
  return table;
}

const Schema<CrowdColorParams>& CrowdColorParams::schema() {
  static const Schema<CrowdColorParams> table = [] {
    Schema<CrowdColorParams> s("crowd color", "What the colours of hair and skins are multiplied by.");
    s.key("value", &CrowdColorParams::value, {.help = "For all", .min = 0});
    s.key("variation", &CrowdColorParams::variation,
          {.help = "Most that one is lighter or darker, as a share", .min = 0, .max = 1});
    s.key("hue", &CrowdColorParams::hue,
          {.help = "The same for red, green and blue by themselves", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

const Schema<CrowdParams>& CrowdParams::schema() {
  static const Schema<CrowdParams> table = [] {
    Schema<CrowdParams> s(
        "crowd",
        "Many animals from a few characters, each with a pose, size, hair length and colour of its own, "
        "spread evenly over an area and pushed apart where they stand too close; crowds keep clear of those "
        "that stand above them in the scene. Every number is a function of seed and name, not of the frame. "
        "A character that a crowd is made of is not drawn by itself unless it says `drawn: true`.");
    s.key("of", &CrowdParams::of,
          {.help = "Names of characters; each animal is one of them, by chance", .required = true});
    s.key("count", &CrowdParams::count,
          {.help = "How many animals; more than fit are an error", .required = true, .min = 1, .max = 1e6});
    s.key("seed", &CrowdParams::seed, {.help = "Of all random numbers of the crowd"});
    s.key("area", &CrowdParams::area, {.help = "Where their origins may be", .required = true});
    s.key("spacing", &CrowdParams::spacing,
          {.unit = "scene units",
           .help = "Least distance between two footprints; between origins where characters have none",
           .min = 0});
    s.key("heading", &CrowdParams::heading, {.help = "Which way they look", .default_text = "any way"});
    s.key("phase", &CrowdParams::phase,
          {.help = "Which pose they show", .default_text = "that of the frame"});
    s.key("scale", &CrowdParams::scale, {.help = "How large they are", .default_text = "1"});
    s.key("length", &CrowdParams::length, {.help = "How long their hair is", .default_text = "1"});
    s.key("color", &CrowdParams::color, {.help = "How they differ in colour", .default_text = "1"});
    return s;
  }();
  return table;
}

}  // namespace pelage
