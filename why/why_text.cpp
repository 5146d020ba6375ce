// SPDX-License-Identifier: Apache-2.0
#include "why/why_text.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/counted.h"

namespace pelage {
namespace {

constexpr size_t kMaxSeen = 6;  // lines

std::string text_of(const V3f& v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }
std::string text_of(const Rgb& v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }

std::string percent(double part, double whole) {
  return whole > 0 ? fmt::format("{:.3g} %", 100 * part / whole) : "0 %";
}

std::string seen_text(const PixelWhy& why) {
  std::string text = "seen by its camera samples\n";
  for (size_t i = 0; i < std::min(kMaxSeen, why.seen.size()); ++i) {
    const SeenCount& seen = why.seen[i];
    std::string name = seen.name.empty() ? "nothing" : seen.name;
    if (seen.strand) name += fmt::format(", strand {}", *seen.strand);
    text += fmt::format("  {:>4}  {}\n", seen.samples, name);
  }
  if (why.seen.size() > kMaxSeen)
    text += fmt::format("        and {} more\n",
                        counted(static_cast<int64_t>(why.seen.size() - kMaxSeen), "surface"));
  return text;
}

std::string steps_text(const StrandWhy& strand) {
  std::string text =
      "steps: what each moved the root, the middle and the tip by; the length and widths after it\n";
  text += fmt::format("  {:<10} {:>8} {:>8} {:>8}   {:>8}   {:>8} {:>8} {:>8}\n", "", "root", "middle", "tip",
                      "length", "w root", "w middle", "w tip");
  for (size_t i = 0; i < strand.steps.size(); ++i) {
    const StrandPlaces& after = strand.steps[i].after;
    text += fmt::format("  {:<10}", strand.steps[i].name);
    for (size_t p = 0; p < after.position.size(); ++p) {
      const std::string moved =
          i == 0
              ? ""
              : fmt::format("{:.3g}", (after.position[p] - strand.steps[i - 1].after.position[p]).length());
      text += fmt::format(" {:>8}", moved);
    }
    text += fmt::format("   {:>8.4g}  ", after.length);
    for (const float width : after.width) text += fmt::format(" {:>8.3g}", width);
    if (after.color && i > 0 && strand.steps[i - 1].after.color != after.color)
      text += fmt::format("   colour {} to {}", text_of((*after.color)[0]), text_of((*after.color)[2]));
    text += "\n";
  }
  const StrandPlaces& end = strand.places();
  text += fmt::format("  root at {}, tip at {}\n", text_of(end.position[0]), text_of(end.position[2]));
  return text;
}

std::string lod_text(const StrandWhy& strand) {
  if (!strand.lod) return "level of detail: not reduced\n";
  const LodWhy& lod = *strand.lod;
  const LodMeasures& m = lod.measures;
  return fmt::format(
             "level of detail: kept; {:.3g} of the strands are kept here, and its priority is {:.3g}\n",
             m.share, lod.priority) +
         fmt::format(
             "  mean strand {:.3g} x {:.3g} pixels, motion {:.3g} (across {:.3g}), disc of confusion "
             "{:.3g}, facing {:.3g}\n",
             m.width, m.length, m.motion, m.across, m.confusion, m.facing) +
         fmt::format("  factors: size {:.3g}, blur {:.3g}, facing {:.3g}, role {:.3g}\n", m.size_share,
                     m.blur_share, m.facing_share, m.budget) +
         fmt::format("  width x {:.3g} (fade {:.3g}), contrast x {:.3g}, fewer points within {:.3g} units\n",
                     lod.width, lod.fade, lod.contrast, lod.tolerance);
}

std::string strand_text(const StrandWhy& strand) {
  std::string text = fmt::format("strand {} of {}\n", strand.id, strand.coat);
  if (strand.root)
    text +=
        fmt::format("  root: face {}, u {:.4g}, v {:.4g}; texture coordinates {:.4g} {:.4g}\n",
                    strand.root->face, strand.root->u, strand.root->v, strand.root_uv.x, strand.root_uv.y);
  text += fmt::format("  rest position of the root: {}\n", text_of(strand.rest));
  text += fmt::format("  hit at {:.1f} % of the strand from the root (segment {}), {:+.2f} radii across\n",
                      100 * strand.along, strand.segment, strand.across);
  return text + steps_text(strand) + lod_text(strand);
}

std::string material_text(const MaterialWhy& material) {
  std::string text =
      fmt::format("material {} ({}): colour here {}", material.name, material.model, text_of(material.color));
  if (material.opacity < 1) text += fmt::format(", opacity {:.3g}", material.opacity);
  text += "\n";
  for (const ParameterText& parameter : material.parameters)
    text += fmt::format("  {}: {}\n", parameter.key, parameter.text);
  return text;
}

std::string chunk_text(const ChunkWhy& chunk) {
  const std::string grew = chunk.growths == 0   ? "kept from an earlier picture"
                           : chunk.growths == 1 ? "grown once"
                                                : fmt::format("grown {} times", chunk.growths);
  return fmt::format("chunk {}: {}, {:.1f} KiB, {} cell bounds, {}\n  box {} to {}\n", chunk.index,
                     counted(static_cast<int64_t>(chunk.strands), "strand"),
                     static_cast<double>(chunk.bytes) / 1024, chunk.segment_cell_bounds, grew,
                     text_of(chunk.box.min), text_of(chunk.box.max));
}

std::string light_text(const PixelWhy& why) {
  std::string text = "light\n";
  const float whole = luminance(why.radiance);
  for (const LightTerm& term : why.lights) {
    if (term.radiance == Rgb(0)) continue;
    const std::string name = term.light + " " + term.lobe + (term.event.empty() ? "" : " " + term.event);
    text += fmt::format("  {:>7}  {:<28} {}\n", percent(luminance(term.radiance), whole), name,
                        text_of(term.radiance));
  }
  return text;
}

}  // namespace

std::string why_text(const PixelWhy& why) {
  std::string text = fmt::format("pixel {} {}: radiance {}, alpha {:.4g}, {}", why.x, why.y,
                                 text_of(why.radiance), why.alpha, counted(why.samples, "sample"));
  if (why.noise)
    text += fmt::format(", noise {:.3g} ({} of the luminance)", *why.noise,
                        percent(*why.noise, luminance(why.radiance)));
  text += "\n";
  if (why.is_adaptive) text += "  sampling is adaptive: the picture may take fewer samples here\n";
  if (why.strand) text += strand_text(*why.strand);
  if (why.skin) {
    text += fmt::format(
        "skin {}\n  face {}, u {:.4g}, v {:.4g}; texture coordinates {:.4g} {:.4g}\n  rest position: {}\n",
        why.skin->name, why.skin->face, why.skin->place.x, why.skin->place.y, why.skin->uv.x, why.skin->uv.y,
        text_of(why.skin->rest));
  }
  if (!why.strand && !why.skin) text += "nothing: the camera sees neither fur nor skin here, only lights\n";
  if (why.material) text += material_text(*why.material);
  if (why.chunk) text += chunk_text(*why.chunk);
  text += seen_text(why) + light_text(why);
  const CostWhy& cost = why.cost;
  text += fmt::format("cost: {} camera, {} shadow, {} indirect rays in {:.3g} CPU s", cost.rays.camera,
                      cost.rays.shadow, cost.rays.indirect, cost.trace_s);
  if (cost.strands_grown > 0)
    text += fmt::format("; {} grown in {:.3g} CPU s", counted(cost.strands_grown, "strand"), cost.growth_s);
  return text + "\n";
}

}  // namespace pelage
