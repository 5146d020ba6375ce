// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/path/path_integrator_test.cpp.
#include "render/scene/render_params.h"

namespace pelage {

bool ValueReader<LodCamera>::read(const Value& value, const KeyOptions& options, LodCamera& out,
                                  Problems& problems) {
  if (value.is_map())
    return ValueReader<std::optional<CameraParams>>::read(value, options, out.own, problems);
  if (value.is_scalar() && value.text() == "main") {
    out.own.reset();
    return true;
  }
  problems.add(value.position(), "expected main or a block with the keys of camera, got " + value.describe());
  return false;
}

const Schema<LodParams>& LodParams::schema() {
  static const Schema<LodParams> table = [] {
    Schema<LodParams> s(
        "lod",
        "Level of detail: of strands too thin, too fast or too blurred to be told apart, fewer "
        "are grown, and those are wider.");
    s.key("enabled", &LodParams::enabled, {.help = "false grows every strand"});
    s.key(
        "camera", &LodParams::camera,
        {.help = "Camera whose view decides, and whose shutter and lens are those whose blur counts: one for "
                 "both eyes of a stereo pair, or for shots that show the same hair"});
    s.key("in_full", &LodParams::full_detail,
          {.help = "So many characters with a coat keep every hair, evenly chosen in the order of their "
                   "distance from that camera; to measure what the others save",
           .min = 0});
    add_simplification_keys(s);
    return s;
  }();
  return table;
}

const Schema<BvhParams>& BvhParams::schema() {
  static const Schema<BvhParams> table = [] {
    Schema<BvhParams> s("bvh", "Trees over fur that are built once and read by later runs.");
    s.key(
        "file", &BvhParams::file,
        {.help = "Folder that keeps the fur of each frame with its trees, in a file named by everything that "
                 "made it. Later runs read chunks from it when rays need them, under `memory`, instead of "
                 "growing them. With `accel: fur`, flat strands and opaque coats",
         .default_text = "none"});
    return s;
  }();
  return table;
}

const Schema<RenderParams>& RenderParams::schema() {
  static const Schema<RenderParams> table = [] {
    Schema<RenderParams> s("render", "How the picture is computed.");
    s.key("integrator", &RenderParams::integrator, {.help = "Method"});
    s.key(
        "accel", &RenderParams::accel,
        {.help =
             "What strands are traced with. `fur`: our own tree over them, two thirds as large; `embree`: "
             "Embree's curves. Rays follow the same rules in both, with level of detail and without; the two "
             "differ where a ray passes the edge of a strand, whose points our tree rounds and whose "
             "curves Embree takes in straight pieces. Skins, and strands with `curves: round`, are "
             "Embree's either way"});
    s.key("curves", &RenderParams::curves,
          {.help = "Strands as ribbons that face each ray, or as round tubes (slower, for close-ups; always "
                   "by Embree)"});
    s.key("samples", &RenderParams::samples,
          {.help = "Paths per pixel; with `adaptive`, the most that a pixel gets", .min = 1, .max = 1 << 20});
    s.key("adaptive", &RenderParams::adaptive, {.help = "Samples where the noise is"});
    s.key(
        "time_limit", &RenderParams::time_limit,
        {.unit = "seconds",
         .help = "Time budget of a frame: it gets as many samples as fit; 0 is no limit. A picture that ran "
                 "into it says so in its header (`pelage:timeLimited`): another run may give others",
         .min = 0,
         .max = 1e7});
    s.key("light_samples", &RenderParams::light_samples,
          {.help =
               "Shadow rays of each scattering: more is slower and less noisy, about as much as more samples "
               "are",
           .min = 1,
           .max = 64});
    s.key(
        "bounces", &RenderParams::bounces,
        {.help = "Most scatterings of a path after the first; 0 = direct light only", .min = 0, .max = 1024});
    s.key(
        "clamp_indirect", &RenderParams::clamp_indirect,
        {.unit = "radiance",
         .help =
             "Maximum luminance that one path adds by indirect light: removes fireflies of few samples and "
             "darkens the picture. 0 is no limit. The fraction of indirect light that is lost is reported at "
             "the end of each frame, and in `--stats` as `clamped_fraction`",
         .min = 0});
    s.key("seed", &RenderParams::seed, {.help = "Of all random numbers of the picture"});
    s.key(
        "memory", &RenderParams::memory,
        {.help =
             "Maximum memory for everything a scene needs, temporary memory included: strands, trees, skins, "
             "grooms, crowds, caches, textures and film. The program and its libraries come on top. Data "
             "that "
             "can be made again is dropped when memory runs short; anything else that does not fit is "
             "refused "
             "by name before it is made"});
    s.key("bvh", &RenderParams::bvh, {.help = "Trees that are kept between runs", .default_text = "none"});
    s.key("compact_attributes", &RenderParams::compact_attributes,
          {.help = "Colours of grown strands are held as seldom and as coarsely as loses nothing that shows; "
                   "false holds them as they were computed"});
    s.key("bounds", &RenderParams::bounds,
          {.help = "How the boxes are found that rays are tested against before hair is grown. `none`: not "
                   "needed, all hair is grown at once; `user`: conservative ones times `bounds_factor`; "
                   "`conservative`: from skin, lengths and operators; `exact`: hair is grown once before, "
                   "to be measured; `exact-shutter`: the same, only while the shutter is open; `linear`: the "
                   "same, moving with the hair"});
    s.key("bounds_factor", &RenderParams::bounds_factor,
          {.help = "Size of the boxes of `bounds: user` relative to conservative ones; below 1, hair may be "
                   "lost",
           .min = 0.01,
           .max = 100});
    s.key("lod", &RenderParams::lod, {.help = "Level of detail", .default_text = "on"});
    s.key("shared_topology", &RenderParams::shared_topology,
          {.help =
               "Animals of one cage share its refinement and patches; false only to measure what it saves"});
    return s;
  }();
  return table;
}

}  // namespace pelage
