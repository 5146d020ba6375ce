// SPDX-License-Identifier: Apache-2.0
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
    Schema<LodParams> s("lod",
                        "Level of detail: where strands are too thin, too fast or too blurred to tell apart, "
                        "Pelage grows fewer and wider strands.");
    s.set_example(R"(render:
  lod: {quality: 2, guard: 2, backfacing: false})");
    s.key("enabled", &LodParams::enabled, {.help = "false grows every strand"});
    s.key(
        "camera", &LodParams::camera,
        {.help = "Camera that decides the level of detail by its view, shutter and lens. Use one camera for "
                 "both eyes of a stereo pair, or for all shots that show the same hair"});
    for (const char* name : {"full_detail_characters", "in_full"})
      s.remove({name, "use `enabled: false` for full detail", "0"});
    add_simplification_keys(s);
    return s;
  }();
  return table;
}

const Schema<BvhParams>& BvhParams::schema() {
  static const Schema<BvhParams> table = [] {
    Schema<BvhParams> s(
        "bvh", "Stores fur, its ray-tracing trees and skins, so that later runs need not make them.");
    s.set_example(R"(render: {bvh: {file: bvh}})");
    s.key("file", &BvhParams::file,
          {.help = "Folder that stores the fur of each frame with its trees, and the triangles of its "
                   "skins. Each file is named by a hash of everything that determines its content. When a "
                   "ray in a later run needs a chunk, "
                   "Pelage reads it from such a file instead of growing it. The limit `memory` still "
                   "applies. Works only with `accel: fur`, `curves: flat` and opaque coats",
           .default_text = "none",
           .written = true});
    return s;
  }();
  return table;
}

namespace {

/// How light that is scattered more than once is found.
void add_bounce_keys(Schema<RenderParams>& s) {
  s.key("bounces", &RenderParams::bounces,
        {.help = "Maximum number of indirect bounces; 0 is direct light only. Light-coloured fur needs "
                 "many bounces",
         .min = 0,
         .max = 1024});
  s.key("indirect", &RenderParams::indirect,
        {.help =
             "How light that is scattered more than once is found. `path`: by `bounces` of paths. `dual`: "
             "by dual scattering, a fast preview for fur: shadow rays count the strands between a point "
             "and a light, and the average fibre tells how much light such strands pass on and scatter "
             "back. Its mean brightness may be wrong by half or more: see DUAL.md. Needs `integrator: path`; "
             "`bounces` has no effect, and light from skins and lights behind bends of the coat is left "
             "out"});
}

/// What saves shadow rays and makes them cheaper.
void add_occlusion_keys(Schema<RenderParams>& s) {
  s.key("skin_ball", &RenderParams::skin_ball,
        {.help = "Balls inside closed skins that replace shadow rays. `exact`: a ray that a ball proves "
                 "blocked is not traced, and points on lights behind it are not chosen; the picture has "
                 "the same mean. `off`: every shadow ray is traced",
         .default_text = "exact with `integrator: gather` and at most 8 skins; otherwise off",
         .removed = {"fractional", "it made coats up to 12 % too bright; use exact"}});
  s.remove({"learned_visibility",
            "it took longer than it saved; `integrator: gather` learns which light arrives by itself",
            "false"});
  s.key("screen_door", &RenderParams::screen_door,
        {.help = "For shadow rays and indirect rays, strands that are not opaque become opaque strands "
                 "whose width is width times opacity. These rays then end at the first strand, which saves "
                 "time; the mean light stays the same. Camera rays still see semi-transparent strands"});
  s.remove(
      {"occlusion_detail", "it gained too little for its growth and approximation; leave it out", "false"});
}

}  // namespace

const Schema<RenderParams>& RenderParams::schema() {
  static const Schema<RenderParams> table = [] {
    Schema<RenderParams> s("render", "Rendering method, quality and limits.");
    s.set_example(R"(render: {samples: 256, bounces: 8, memory: 8G})");
    s.key("integrator", &RenderParams::integrator,
          {.help =
               "`gather`: samples that see the same piece of a strand or skin share shadow rays and indirect "
               "light. Single pixels reach the same noise in half to a thirteenth of the time, but shadows "
               "blur "
               "along strands by `gather.spacing`. `path`: every sample of a pixel is a path of its own; the "
               "reference"});
    s.key("gather", &RenderParams::gather,
          {.help = "Settings of `integrator: gather`", .default_text = "as below"});
    s.key("accel", &RenderParams::accel,
          {.help = "Ray-tracing structure for strands. `fur`: Pelage's own tree, two thirds the size of "
                   "Embree's; `embree`: Embree's curves. Both give the same result except at the edges of "
                   "strands, because our tree rounds control points and Embree splits curves into straight "
                   "pieces. Embree always traces skins, and with `curves: round` also strands"});
    s.key("curves", &RenderParams::curves,
          {.help = "`flat`: strands are ribbons that face each ray; `round`: strands are round tubes "
                   "(slower, for close-ups; Embree traces them)"});
    s.key("samples", &RenderParams::samples,
          {.help = "Paths per pixel; with `adaptive`, the maximum per pixel", .min = 1, .max = 1 << 20});
    s.key("adaptive", &RenderParams::adaptive, {.help = "Takes more samples in noisy pixels"});
    s.key("time_limit", &RenderParams::time_limit,
          {.unit = "seconds",
           .help = "Time limit per frame: the frame gets as many samples as fit into it; 0 is no limit. The "
                   "header of a picture that reached the limit contains `pelage:timeLimited`, because "
                   "another run may take a different number of samples",
           .min = 0,
           .max = 1e7});
    s.key("light_samples", &RenderParams::light_samples,
          {.help = "Shadow rays per visible point; later surfaces of a path get twice as many. More rays "
                   "reduce noise but take longer, much like more samples",
           .min = 1,
           .max = 64});
    add_bounce_keys(s);
    add_occlusion_keys(s);
    s.key("clamp_indirect", &RenderParams::clamp_indirect,
          {.unit = "radiance",
           .help = "Maximum luminance of the indirect light of one path. It removes fireflies and darkens "
                   "the picture; 0 is no limit. At the end of each frame, Pelage reports the fraction of "
                   "indirect light that is lost; `--stats` writes it as `clamped_fraction`",
           .min = 0});
    s.key("seed", &RenderParams::seed, {.help = "Seed of all random numbers of the picture"});
    s.key("memory", &RenderParams::memory,
          {.help = "Maximum memory for everything a scene needs, including temporary memory: strands, "
                   "trees, skins, grooms, crowds, caches, textures and film. The program and its libraries "
                   "are not counted. When memory runs short, Pelage drops data that it can make again; "
                   "anything else that does not fit is refused before it is made, with an error that names "
                   "it"});
    s.key("bvh", &RenderParams::bvh, {.help = "Stored trees for later runs", .default_text = "none"});
    s.key("compact_attributes", &RenderParams::compact_attributes,
          {.help = "Stores colours of grown strands with as few values and bits as possible without visible "
                   "loss; false stores them as computed"});
    s.key(
        "bounds", &RenderParams::bounds,
        {.help = "How Pelage finds the bounding boxes of chunks. Rays are tested against these boxes before "
                 "strands grow. `none`: no boxes, all strands grow before rendering; `conservative`: boxes "
                 "from the skin, strand lengths and operators; "
                 "`exact`: strands grow once beforehand and are measured over the whole time from half a "
                 "frame before to half a frame after the frame. If all chunks take at most half of the free "
                 "part of `memory`, and no groom has a cache, they are kept instead of growing again, as "
                 "with `none`; `exact-shutter`: as `exact`, but measured "
                 "only while the shutter is open; `linear`: "
                 "as `exact-shutter`, with boxes that move with the strands",
         .removed = {"user", "boxes that it made smaller could lose strands; use conservative or exact"}});
    s.remove({"bounds_factor", "it belonged to `bounds: user`, which could lose strands", "1"});
    s.key("lod", &RenderParams::lod, {.help = "Level of detail", .default_text = "on"});
    s.remove({"shared_topology", "characters with the same cage always share its refinement", "true"});
    return s;
  }();
  return table;
}

}  // namespace pelage
